//! Whatever a text is, it is read or refused: no panic, no endless wait.

use crate::good::{GOOD, complaints};
use proptest::prelude::*;
use sinew::scene::schema::Scene;
use sinew::scene::{SceneFile, load};
use std::path::Path;

/// One thing that happens to a text.
#[derive(Clone, Debug)]
enum Change {
    Truncate(usize),
    Byte(usize, u8),
    Remove(usize, usize),
    Double(usize),
    Drop(usize),
    Move(usize, usize, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let size = GOOD.len();
    let lines = GOOD.lines().count();
    let typed = prop::sample::select(b"()[]{}:,\"'/*-+.0eE#rb\\ \nxX_=\xc3\x00".to_vec());
    prop_oneof![
        (0..size).prop_map(Change::Truncate),
        (0..size, typed).prop_map(|(at, byte)| Change::Byte(at, byte)),
        (0..size, any::<u8>()).prop_map(|(at, byte)| Change::Byte(at, byte)),
        (0..size, 1..20usize).prop_map(|(at, length)| Change::Remove(at, length)),
        (0..lines).prop_map(Change::Double),
        (0..lines).prop_map(Change::Drop),
        (0..size, 1..40usize, 0..size).prop_map(|(at, length, to)| Change::Move(at, length, to)),
    ]
}

fn apply(text: &[u8], change: &Change) -> Vec<u8> {
    let mut bytes = text.to_vec();
    let size = bytes.len();
    let mut lines: Vec<&[u8]> = text.split_inclusive(|byte| *byte == b'\n').collect();
    match *change {
        Change::Truncate(at) => bytes.truncate(at),
        Change::Byte(at, byte) if at < size => bytes[at] = byte,
        Change::Remove(at, length) if at < size => drop(bytes.drain(at..(at + length).min(size))),
        Change::Move(at, length, to) if at < size => {
            let piece: Vec<u8> = bytes.drain(at..(at + length).min(size)).collect();
            let to = to.min(bytes.len());
            bytes.splice(to..to, piece);
        }
        Change::Double(line) if line < lines.len() => {
            lines.insert(line, lines[line]);
            return lines.concat();
        }
        Change::Drop(line) if line < lines.len() => {
            lines.remove(line);
            return lines.concat();
        }
        _ => {}
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn a_mutated_scene_is_read_or_refused(changes in prop::collection::vec(change(), 1..5)) {
        let bytes = changes.iter().fold(GOOD.as_bytes().to_vec(), |text, change| apply(&text, change));
        let text = String::from_utf8_lossy(&bytes);
        let read = SceneFile::from_text("cube.ron", &text, Path::new(""), &[]);
        // refused means that something is said, in every form
        let told = complaints(&text, &[]);
        prop_assert_eq!(told.lines().len(), told.list().len());
        prop_assert!(read.is_ok() || (told.has_errors() && told.render(true).len() > 20));
        // a name that stands twice, or a number out of bounds, is refused here and not by ron; all else alike
        if let Ok(read) = read {
            prop_assert_eq!(load::options().from_str::<Scene>(&text), Ok(read.scene), "{}", text);
        }
    }

    #[test]
    fn any_set_is_put_in_or_refused(set in "(duration|loads|bodies|title|x)?[a-z.\\[\\]0-9\"=() :,]{0,20}(=[-a-z0-9(), \"\\[{]{0,12})?") {
        let _ = complaints(GOOD, &[&set]).render(false);
    }
}

#[test]
fn deep_nesting_is_refused_and_not_followed() {
    for (open, close) in [("(", ")"), ("[", "]"), ("{\"a\":", "}"), ("Not(", ")"), ("(a:", ")"), ("/*", "*/")] {
        let text = format!("{}{}", open.repeat(100_000), close.repeat(100_000));
        assert!(complaints(&text, &[]).has_errors());
    }
    let deep = format!("loads={}1{}", "[".repeat(70), "]".repeat(70));
    assert!(complaints(GOOD, &[&deep]).to_string().contains("nested more than 64 deep"));
}

#[test]
fn many_mistakes_are_told_in_bounded_space() {
    let bodies = |count: usize| {
        let bodies: String = (0..count).map(|i| format!("\"b{i}\": (mesh: 3),\n")).collect();
        format!("(duration: 1, materials: {{}}, bodies: {{{bodies}}})")
    };
    let text = bodies(20_000);
    let wrong_values =
        bodies(900).replace("(mesh: 3)", "(mesh: Box(size: (1, 1, 1), cells: (1, 1, 0)), material: \"m\")");
    let told = complaints(&wrong_values, &[]).to_string();
    assert!(told.contains("and 1750 more") && told.lines().count() < 1000, "{told}");
    let told = complaints(&text, &[]);
    let shown = told.to_string();
    assert!(told.list().len() >= 20_000);
    assert!(shown.lines().count() < 1000 && shown.contains("more"), "{shown}");
}
