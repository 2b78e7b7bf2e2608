#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::*;

fn given() -> BTreeMap<String, f64> {
    [("a", 1.0), ("b", 2.0), ("c", 3.0)].map(|(name, x)| (name.to_owned(), x)).into()
}

fn body(formula: &str) -> String {
    let used: BTreeMap<String, f64> = given().into_iter().filter(|(name, _)| formula.contains(name)).collect();
    let wrapped = wrap(formula, &used).unwrap_or_else(|wrong| panic!("{formula}: {wrong:?}"));
    let (_, body) = wrapped.text.split_once("return ").unwrap();
    body.split(';').next().unwrap().replace("parameter_", "").replace(' ', "")
}

#[test]
fn powers_have_the_rank_they_have_on_paper() {
    for (formula, expected) in [
        ("a^b", "pow(a,b)"),
        ("-a^b", "-pow(a,b)"),
        ("a^-b", "pow(a,-b)"),
        ("a^b^c", "pow(a,pow(b,c))"),
        ("a*b^2*c", "a*pow(b,2.0)*c"),
        ("(a+b)^2 + 1/2", "pow((a+b),2.0)+1.0/2.0"),
        ("exp(a^2)^(b - 1)", "pow(exp(pow(a,2.0)),(b-1.0))"),
        ("max(a^2, b^3)^c", "pow(max(pow(a,2.0),pow(b,3.0)),c)"),
        ("J^(-2/3)", "pow(J,(-2.0/3.0))"),
        ("a^-b^2/c", "pow(a,-pow(b,2.0))/c"),
    ] {
        assert_eq!(body(formula), expected, "{formula}");
    }
}

#[test]
fn places_lead_back() {
    let formula = "a/2*I1bar_minus_3^b";
    let used = given().into_iter().filter(|(name, _)| name != "c").collect();
    let wrapped = wrap(formula, &used).unwrap();
    let at = wrapped.text.rfind("I1bar").unwrap();
    let complaint = wrapped.led_back(Complaint::new(About::Bytes(at..at + 3), "wrong"));
    assert_eq!(complaint.about, About::Bytes(4..17));
}
