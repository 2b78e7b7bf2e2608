use super::*;

#[test]
fn bytes_know_where_they_came_from() {
    let mut source = Source::new("a.ron", "(a: 1, b: 2)", &["a=777".into()]);
    source.replace(4..5, &[("777", Origin::of(1, 2))]);
    assert_eq!(source.text(), "(a: 777, b: 2)");
    assert_eq!(source.place(&(4..7)), TextSpan { text: 1, span: 2..5 });
    assert_eq!(source.place(&(12..13)), TextSpan { text: 0, span: 10..11 });
    // a span that holds a replaced value reaches around it
    assert_eq!(source.place(&(0..14)), TextSpan { text: 0, span: 0..12 });
    source.replace(5..6, &[("", Origin::of(1, 0))]);
    assert_eq!(source.text(), "(a: 77, b: 2)");
    assert_eq!(source.place(&(5..6)), TextSpan { text: 1, span: 4..5 });
}

#[test]
fn a_text_put_into_another_keeps_where_it_came_from() {
    let mut part = Source::of(2, "(c: 3)");
    part.replace(4..5, &[("4", Origin::of(1, 2))]);
    let mut source = Source::new("a.ron", "(a: 1)", &["a=4".into()]);
    let stretches = part.stretches(&(1..6));
    let stretches: Vec<_> = stretches.iter().map(|(text, from)| (text.as_str(), *from)).collect();
    source.replace(4..5, &stretches);
    assert_eq!(source.text(), "(a: c: 4))");
    assert_eq!(source.place(&(4..5)), TextSpan { text: 2, span: 1..2 });
    assert_eq!(source.place(&(7..8)), TextSpan { text: 1, span: 2..3 });
    assert_eq!(source.place(&(9..10)), TextSpan { text: 0, span: 5..6 });
}
