use super::*;

#[test]
fn fields_of_structs_and_variants_have_a_meaning() {
    assert_eq!(
        meaning("Scene", "duration").as_deref(),
        Some(
            "Simulated time (s); the time whose loads and motions a static analysis takes. A file without it may be a \
             part of a scene: see `parts`."
        )
    );
    assert_eq!(meaning("Young", "poisson").as_deref(), Some("Poisson's ratio, below 1/2."));
    assert_eq!(meaning("Pressure", "on").as_deref(), Some("Which faces."));
    assert_eq!(meaning("Gravity", "acceleration").as_deref(), Some("Acceleration (m/s²)."));
    assert_eq!(meaning("Young", "density"), None);
    assert_eq!(meaning("Nobody", "density"), None);
}
