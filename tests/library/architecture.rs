//! The modules use one another as the architecture page of the documentation says.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The line of the page on which each module stands.
fn layers() -> HashMap<String, usize> {
    let page = include_str!("../../src/guide/architecture.md");
    let picture = page.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let lines = picture.lines().map(|line| line.split("  ").next().unwrap());
    lines.enumerate().flat_map(|(i, line)| line.split(' ').map(move |name| (name.to_owned(), i))).collect()
}

/// The modules that the page says are public.
fn public() -> Vec<String> {
    let page = include_str!("../../src/guide/architecture.md");
    let named = page.split("has a public module:\n").nth(1).and_then(|rest| rest.split(".\n").next()).unwrap();
    named.split(',').map(|name| name.trim().trim_matches('`').to_owned()).collect()
}

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}

/// The modules that a file names by `crate::`, outside of comments and tests.
fn used(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let names = lines
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect::<String>());
    names.filter(|name| name.starts_with(|c: char| c.is_ascii_lowercase())).collect()
}

#[test]
fn public_modules_are_those_of_the_page() {
    let front_door = include_str!("../../src/lib.rs");
    let declared = front_door.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
    assert_eq!(declared.collect::<Vec<_>>(), public());
}

#[test]
fn modules_use_only_what_stands_above_them() {
    let (layers, root) = (layers(), Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let (mut files, mut seen, mut uses) = (Vec::new(), Vec::new(), 0);
    sources(&root, &mut files);
    for file in files {
        let inside = file.strip_prefix(&root).unwrap();
        let first = inside.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
        let module = first.trim_end_matches(".rs").to_owned();
        // the front door, the pages and the table of what is compiled once are no layers
        if ["lib", "guide", "heavy"].contains(&module.as_str()) {
            continue;
        }
        let layer = |name: &str| {
            let missing = || panic!("{}: {name} is not in src/guide/architecture.md: add it", inside.display());
            *layers.get(name).unwrap_or_else(missing)
        };
        let text = fs::read_to_string(&file).unwrap();
        // a group would hide what it names
        assert!(!text.split("#[cfg(test)]").next().unwrap().contains("use crate::{"), "{}", inside.display());
        for name in used(&text).into_iter().filter(|name| name != "heavy") {
            assert!(layer(&name) <= layer(&module), "{}: {module} may not use {name}", inside.display());
            let alone = ["error", "grid", "exact"];
            assert!(module != "exact" || alone.contains(&name.as_str()), "exact may not use {name}");
            uses += 1;
        }
        for (foreign, home) in [("rayon::", "par"), ("mpi::", "ranks")] {
            assert!(module == home || !text.contains(foreign), "{}: {foreign} is for {home}", inside.display());
        }
        seen.push(module);
    }
    assert!(layers.keys().all(|name| seen.contains(name)), "a module of the page is gone");
    assert!(uses > 100, "{uses}");
}
