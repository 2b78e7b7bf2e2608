#![allow(clippy::unwrap_used)]

use super::*;

/// (x + 1)(x + 2)/2 − 1, with the graph it is of.
fn shifted(graph: &mut Graph, sign: f64) -> Id {
    let x = graph.input(0);
    let [one, two, half] = [sign, 2.0 * sign, 0.5].map(|c| graph.constant(c));
    let (a, b) = (graph.binary(Binary::Add, x, one), graph.binary(Binary::Add, x, two));
    let product = graph.binary(Binary::Multiply, a, b);
    let halved = graph.binary(Binary::Multiply, half, product);
    let whole = graph.constant(1.0);
    graph.binary(Binary::Subtract, halved, whole)
}

#[test]
fn products_of_sums_are_polynomials() {
    let mut graph = Graph::default();
    let sum = shifted(&mut graph, 1.0);
    let found = graph.polynomials(&[sum], 0.0).unwrap();
    assert_eq!(found, [Polynomial { input: 0, highest: 0.5, lower: vec![1.5, 0.0] }]);
    for x in [0.0, 1e-9, 0.3, 7.0] {
        assert!((found[0].at(&[x], x) - (0.5 * x * x + 1.5 * x)).abs() <= 1e-15 * x);
    }
}

/// Near a place where terms take each other away the form written is the better one.
#[test]
fn what_would_lose_digits_stays_as_it_was_written() {
    let mut graph = Graph::default();
    let sum = shifted(&mut graph, -1.0);
    assert_eq!(graph.polynomials(&[sum], 0.0), None, "0 at x = 3");
    let sum = shifted(&mut graph, 1.0);
    assert_eq!(graph.polynomials(&[sum], -5.0), None, "0 at x = -3");
}

#[test]
fn other_functions_are_none() {
    let mut graph = Graph::default();
    let (x, y) = (graph.input(0), graph.input(1));
    let exponential = graph.unary(Unary::Exp, x);
    let (of_both, quotient) = (graph.binary(Binary::Multiply, x, y), graph.binary(Binary::Divide, x, y));
    for other in [exponential, of_both, quotient] {
        assert_eq!(graph.polynomials(&[other], 0.0), None);
    }
    let mut high = x;
    for power in 2..=HIGHEST + 1 {
        high = graph.binary(Binary::Multiply, high, x);
        assert_eq!(graph.polynomials(&[high, y], 0.0).is_some(), power <= HIGHEST, "{power}");
    }
}
