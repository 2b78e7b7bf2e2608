//! What is public is what a user is meant to call: `cargo doc` lists it, a few hundred items. What crates on top and
//! tests need beside is `#[doc(hidden)]`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;
use std::process::Command;

/// More than there are, by less than a tenth: who adds some sees what there is already.
const MOST: usize = 580;

/// Pages of types, traits and functions, by their paths in the docs of a crate.
fn pages(all: &str) -> Vec<&str> {
    let links = all.split("<li><a href=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let mut pages: Vec<&str> = links.filter(|link| link.ends_with(".html") && !link.starts_with("..")).collect();
    pages.sort_unstable();
    pages.dedup();
    pages
}

/// Methods, constants and types that a page tells of: its own, not those of other traits and not those of what it
/// dereferences to.
fn items_of(page: &str) -> usize {
    let others = ["deref-methods", "trait-implementations", "synthetic-implementations", "blanket-implementations"];
    let own = others.iter().fold(page, |own, part| own.split(&format!("id=\"{part}")).next().unwrap());
    ["method", "associatedconstant", "associatedtype"]
        .iter()
        .map(|kind| own.matches(&format!(" class=\"{kind}\"")).count())
        .sum()
}

#[test]
fn what_a_page_lists_is_counted() {
    let page = "<section id=\"method.step\" class=\"method\"></section><section id=\"method.clone\" class=\"method \
                trait-impl\"></section><section id=\"associatedconstant.NONE\" class=\"associatedconstant\"></section>\
                <details id=\"deref-methods-Vec\"><section id=\"method.len\" class=\"method\"></section></details>";
    assert_eq!(items_of(page), 2);
    let all =
        "<li><a href=\"struct.A.html\">A</a></li><li><a href=\"b/fn.c.html\">c</a></li><li><a href=\"../x.html\">";
    assert_eq!(pages(all), ["b/fn.c.html", "struct.A.html"]);
}

/// The docs are made without a warning: no link of theirs leads to what is private.
#[test]
#[ignore = "long"]
fn what_is_public_is_a_few_hundred_items() {
    let docs = ["doc", "--offline", "--package", "sinew", "--no-deps"];
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(docs).arg("--target-dir").arg(target).env("RUSTDOCFLAGS", "-D warnings").current_dir(root);
    let output = cargo.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let folder = target.join("doc/sinew");
    let all = std::fs::read_to_string(folder.join("all.html")).unwrap();
    let mut counts: Vec<(usize, &str)> = pages(&all)
        .into_iter()
        .map(|page| (items_of(&std::fs::read_to_string(folder.join(page)).unwrap()), page))
        .collect();
    let count = counts.iter().map(|(inside, _)| 1 + inside).sum::<usize>();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    println!("{count} items on {} pages; most: {:?}", counts.len(), &counts[..10]);
    let listed = |page: &str| counts.iter().find(|(_, name)| *name == page).map_or(0, |(inside, _)| *inside);
    assert!(
        listed("struct.Simulation.html") > 50 && listed("systems/trait.NodeSystem.html") > 5,
        "nothing was counted"
    );
    assert!(count <= MOST, "{count} public items, at most {MOST}: hide what nobody is meant to call\n{counts:#?}");
}
