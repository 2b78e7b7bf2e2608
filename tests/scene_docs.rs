//! The reference of the scene format knows every word of the schema, and its examples are sound.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::scene::{SceneFile, validate};
use std::path::Path;

const REFERENCE: &str = include_str!("../docs/scene.md");

/// The names of all fields and variants: what has a comment with three slashes or stands in an enum, and is no
/// function.
fn words_of_the_schema() -> Vec<&'static str> {
    let mut words = sinew::scene::schema::ELASTIC_LAWS.to_vec();
    let mut inside = false;
    for line in sinew::scene::schema::texts().flat_map(|file| file.lines()) {
        let line = line.trim();
        if line.starts_with("pub struct") || line.starts_with("pub enum") {
            inside = true;
        } else if line == "}" {
            inside = false;
        } else if inside {
            let text = line.trim_start_matches("pub ");
            let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
            if end > 0 {
                words.push(&text[..end]);
            }
        }
    }
    words
}

#[test]
fn every_field_and_variant_is_in_the_reference() {
    let mut words = words_of_the_schema();
    words.extend(sinew::scene::schema::LOADS.iter().map(|(_, word, _)| *word));
    // a word that only an example shows is not explained
    let tables: String = REFERENCE.split("```").step_by(2).collect();
    assert!(words.len() > 120, "the schema was read as {} words: {words:?}", words.len());
    for word in words {
        let named = tables.match_indices(word).any(|(at, _)| {
            let part = |c: char| c.is_alphanumeric() || c == '_';
            let (before, after) = (tables[..at].chars().next_back(), &tables[at + word.len()..]);
            // in code, not as a word of a sentence
            !before.is_some_and(part)
                && !after.starts_with(part)
                && (before == Some('`') || after.starts_with([':', '(']))
        });
        assert!(named, "docs/scene.md does not name `{word}`");
    }
}

/// Loads are made of a list: each has a row, with all that it must have.
#[test]
fn every_load_has_its_row_in_the_reference() {
    for (_, word, fields) in sinew::scene::schema::LOADS {
        let row = REFERENCE.lines().find(|line| line.starts_with(&format!("| `{word}` |")));
        let row = row.unwrap_or_else(|| panic!("docs/scene.md has no row for the load `{word}`"));
        for (field, _) in *fields {
            assert!(row.contains(&format!("`{field}`")), "{field} is not in {row}");
        }
    }
}

/// The scene an example stands for: itself, or its fields with the required ones added that it does not give.
fn whole(example: &str) -> String {
    if example.starts_with('(') {
        return example.to_string();
    }
    let mut text = format!("(\n{example}");
    for (field, value) in [
        ("duration", "0.5"),
        ("materials", r#"{"tissue": (density: 1060, neo_hookean: Young(young: 3e3, poisson: 0.45))}"#),
        ("bodies", r#"{"cube": (mesh: Box(size: (1, 1, 1), cells: (4, 4, 4)), material: "tissue")}"#),
    ] {
        if !example.lines().any(|line| line.starts_with(&format!("{field}:"))) {
            text.push_str(&format!("{field}: {value},\n"));
        }
    }
    text + ")\n"
}

#[test]
fn every_example_in_the_reference_is_sound() {
    let examples: Vec<&str> = REFERENCE.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(examples.len() >= 7);
    for example in examples {
        let text = whole(example);
        let scene = SceneFile::from_text("example.ron", &text, Path::new(""), &[])
            .unwrap_or_else(|wrong| panic!("{wrong}\nin\n{text}"));
        let mut wrong = scene.diagnostics();
        validate(&scene, &mut wrong);
        assert!(!wrong.has_errors(), "{wrong}\nin\n{text}");
    }
}

/// All pages of the book, by their names.
fn pages() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let pages = files.filter(|file| file.extension().is_some_and(|ending| ending == "md"));
    pages
        .map(|file| (file.file_name().unwrap().display().to_string(), std::fs::read_to_string(&file).unwrap()))
        .collect()
}

/// Every whole scene in the docs, which begins with a parenthesis; those that name files are tested where they are
/// used.
#[test]
fn every_whole_scene_in_the_docs_is_sound() {
    let mut tested = Vec::new();
    for (page, text) in pages() {
        let scenes = text.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next());
        for scene in
            scenes.filter(|scene| scene.starts_with('(') && !scene.contains("file:") && !scene.contains("path:"))
        {
            let scene =
                SceneFile::from_text(&page, scene, Path::new(""), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
            let mut wrong = scene.diagnostics();
            validate(&scene, &mut wrong);
            assert!(!wrong.has_errors(), "{page}: {wrong}");
            tested.push(page.clone());
        }
    }
    assert!(["first_scene.md", "biomechanics.md", "games.md"].iter().all(|page| tested.iter().any(|t| t == page)));
}

/// The book has all pages, and nothing else; and its links lead to pages and headings that are there.
#[test]
fn the_book_has_every_page_and_its_links_lead_somewhere() {
    let pages = pages();
    let summary = &pages.iter().find(|(page, _)| page == "SUMMARY.md").unwrap().1;
    let links = |text: &str| -> Vec<String> {
        let behind = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        behind.filter(|link| !link.contains("://") && !link.contains(' ')).map(str::to_string).collect()
    };
    let mut listed = links(summary);
    // a page may have pages of its own, in a folder of its name, which are looked for below
    listed.retain(|link| !link.contains('/'));
    listed.sort();
    let mut there: Vec<String> =
        pages.iter().map(|(page, _)| page.clone()).filter(|page| page != "SUMMARY.md").collect();
    there.sort();
    assert_eq!(listed, there);
    // as the book and its hosts make them of headings
    let anchor = |heading: &str| -> String {
        let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        kept.collect::<String>().to_lowercase().replace(' ', "-")
    };
    let headings = |text: &str| -> Vec<String> {
        text.lines().filter(|line| line.starts_with('#')).map(|line| anchor(line.trim_start_matches('#'))).collect()
    };
    for (page, text) in &pages {
        for link in links(text) {
            let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { page } else { file };
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
            assert!(folder.join(target).exists(), "{page} has a link to {link}");
            // of pages that are not its own the book would make links to others, which are not there (.ci/book)
            let is_foreign = target.starts_with("../") && target.ends_with(".md");
            assert!(!is_foreign, "{page} has a link to {link}: name its folder");
            if let Some((_, text)) = pages.iter().find(|(other, _)| other == target).filter(|_| !heading.is_empty()) {
                assert!(
                    headings(text).iter().any(|h| h == heading),
                    "{page} has a link to {link}: there is no such heading"
                );
            }
        }
    }
}

#[test]
fn a_scene_written_and_read_again_is_the_same() {
    for example in REFERENCE.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next()) {
        let read = |text: &str| {
            SceneFile::from_text("a.ron", text, Path::new(""), &[]).unwrap_or_else(|e| panic!("{e}")).scene
        };
        let scene = read(&whole(example));
        let plain = ron::ser::to_string_pretty(&scene, ron::ser::PrettyConfig::default()).unwrap();
        assert_eq!(read(&plain), scene, "{plain}");
        let named = ron::ser::PrettyConfig::default().struct_names(true);
        let named = ron::ser::to_string_pretty(&scene, named).unwrap();
        assert_eq!(read(&named), scene, "{named}");
    }
}

#[test]
fn the_named_sets_of_generators_are_in_the_reference() {
    use sinew::mesh::{ElementKind::Hex8, Mesh, generators::*};
    let cells = (4, 8, 2);
    let corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)];
    let corners = corners.map(|(x, y, z)| glam::DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
    let meshes: [(&str, Mesh); 6] = [
        ("Box", box_mesh(glam::DVec3::ONE, cells, Hex8).unwrap()),
        ("Hexahedron", hexahedron_mesh(corners, cells, Hex8).unwrap()),
        ("Tube", tube_mesh(1.0, 2.0, 1.0, 90.0, cells, Hex8).unwrap()),
        ("Cylinder", cylinder_mesh(1.0, 1.0, 4, 2, Hex8).unwrap()),
        ("Ellipsoid", ellipsoid_mesh(glam::DVec3::ONE, 4, Hex8).unwrap()),
        ("Lens", lens_mesh(2.0, 1.0, 4, 2, Hex8).unwrap()),
    ];
    let table = REFERENCE.split("#### Named sets").nth(1).unwrap().split("####").next().unwrap();
    for (name, mesh) in &meshes {
        let row = table.lines().find(|line| line.starts_with(&format!("| `{name}` |"))).unwrap();
        let named: Vec<&str> = row.split('`').skip(3).step_by(2).filter(|word| *word != "size").collect();
        let mut named: Vec<String> = named.into_iter().map(str::to_string).collect();
        named.sort();
        let there: Vec<String> = mesh.node_sets.keys().cloned().collect();
        assert_eq!(named, there, "{name}");
        assert_eq!(mesh.face_sets.keys().cloned().collect::<Vec<_>>(), there);
    }
}
