#![allow(clippy::unwrap_used)]

use super::Parameters;
use serde::Serialize;

#[derive(Serialize)]
struct Wind {
    strength: f64,
    along: [f32; 3],
    turns: i32,
    places: u16,
    on: bool,
}

#[test]
fn members_are_laid_out_by_their_types() {
    for turns in [2, -2] {
        let wind = Wind { strength: 1.5, along: [1.0, 2.0, 3.0], turns, places: 7, on: true };
        let Parameters { declared, bytes } = Parameters::of("parameters", &wind).unwrap();
        let expected = "struct Parameters {\n    @align(16) strength: f32,\n    @align(16) along: vec3<f32>,\n    \
             @align(16) turns: i32,\n    @align(16) places: u32,\n    @align(16) on: u32,\n}\n\
             @group(0) @binding(0) var<uniform> parameters: Parameters;\n";
        assert_eq!(declared, expected);
        let word = |place: usize| u32::from_le_bytes(bytes[4 * place..4 * place + 4].try_into().unwrap());
        let all = [1.5f32.to_bits(), 1f32.to_bits(), 2f32.to_bits(), 3f32.to_bits(), turns.cast_unsigned(), 7, 1];
        assert_eq!([0, 4, 5, 6, 8, 12, 16].map(word), all);
        assert_eq!(bytes.len(), 80);
    }
}

#[test]
fn what_a_shader_cannot_have_is_named() {
    #[derive(Serialize)]
    struct Odd<T> {
        size: T,
    }
    fn said<T: Serialize>(size: T) -> String {
        Parameters::of("parameters", &Odd { size }).unwrap_err()
    }
    assert_eq!(said("large"), "`size`: a text is nothing that a shader can have");
    assert_eq!(said(vec![1.0, 2.0]), "`size`: a list of any length is nothing that a shader can have");
    assert_eq!(said([1u32, 2]), "`size`: a vector of `u32`; only vectors of real numbers can be");
    assert_eq!(said([1.0; 5]), "`size`: 5 numbers; a vector has two to four");
    assert_eq!(said(1u64 << 32), "`size`: 4294967296 is more than 32 bits hold");
    assert_eq!(said(None::<f32>), "`size`: a value that is not there is nothing that a shader can have");
    assert_eq!(
        Parameters::of("parameters", &[1.0, 2.0]).unwrap_err(),
        "a list without a name is nothing that a shader can have"
    );
    #[derive(Serialize)]
    struct Plain;
    assert_eq!(Parameters::of("parameters", &Plain), Ok(Parameters::default()));
}
