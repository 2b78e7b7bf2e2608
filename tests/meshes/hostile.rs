//! Files cut short and changed at random: read or refused, never a panic.

use crate::{readers, samples};
use proptest::prelude::*;
use sinew::mesh::vtu;
use std::sync::LazyLock;

static FILES: LazyLock<Vec<(String, Vec<u8>)>> = LazyLock::new(samples::all);

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_file_cut_short_or_changed_makes_a_panic(
        file in 0usize..1000,
        cut in 0.0f64..1.3,
        changes in prop::collection::vec((0.0f64..1.0, any::<u8>()), 0..4),
        digits in prop::collection::vec((0.0f64..1.0, b'0'..=b'9'), 0..3),
    ) {
        let (name, mut bytes) = FILES[file % FILES.len()].clone();
        bytes.truncate((bytes.len() as f64 * cut.min(1.0)) as usize);
        let length = bytes.len();
        for (place, byte) in changes.into_iter().chain(digits) {
            if let Some(at) = bytes.get_mut((place * length as f64) as usize) {
                *at = byte;
            }
        }
        if let Ok(mesh) = readers::read_turning(&name, &bytes, true) {
            prop_assert!(mesh.soundness().is_sound());
            mesh.surface();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let _ = vtu::read(&path);
    }
}

#[test]
fn every_truncation_of_every_format_is_refused_or_read() {
    for (name, bytes) in FILES.iter().filter(|(name, _)| !name.contains("-8-")) {
        for length in (0..bytes.len()).step_by(7) {
            if let Err(error) = readers::read(name, &bytes[..length]) {
                assert!(error.to_string().contains("; "), "says what to do: {error}");
            }
        }
    }
}

#[test]
fn deeply_nested_xml_is_refused() {
    let text = "<a>".repeat(200_000);
    assert!(readers::read("deep.vtu", text.as_bytes()).is_err());
}
