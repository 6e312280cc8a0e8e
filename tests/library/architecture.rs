//! The modules use one another as the architecture page of the documentation says.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The floors of a crate by its folder: the line of the page on which each module stands.
type Floors = HashMap<String, usize>;

/// The pictures of the page, each behind the name of its folder.
fn pictures() -> Vec<(String, Floors)> {
    let page = include_str!("../../src/guide/architecture.md");
    let floors = |picture: &str| {
        let lines = picture.lines().map(|line| line.split("  ").next().unwrap());
        lines.enumerate().flat_map(|(i, line)| line.split(' ').map(move |name| (name.to_owned(), i))).collect()
    };
    let parts: Vec<_> = page.split("```text\n").collect();
    let named = parts.windows(2).map(|two| (two[0].trim_end().rsplit('\n').next().unwrap(), two[1]));
    let drawn = named.filter_map(|(name, rest)| Some((name.strip_suffix(":")?.rsplit('`').nth(1)?, rest)));
    drawn.map(|(folder, rest)| (folder.to_owned(), floors(rest.split("```").next().unwrap()))).collect()
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

/// The modules that a file names by `crate::`, also in a group, outside of comments and tests.
fn used(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap();
    let lines: Vec<_> = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let code = lines.join(" ");
    let named = code.split("crate::").skip(1).flat_map(|rest| match rest.strip_prefix('{') {
        Some(group) => group.split('}').next().unwrap().split(',').collect(),
        None => vec![rest],
    });
    let names = named
        .map(|rest| rest.trim().chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect::<String>());
    names.filter(|name| name.starts_with(|c: char| c.is_ascii_lowercase())).collect()
}

#[test]
fn public_modules_are_those_of_the_page() {
    let front_door = include_str!("../../src/lib.rs");
    let declared = front_door.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
    assert_eq!(declared.collect::<Vec<_>>(), public());
}

#[test]
fn modules_use_only_what_stands_above_them_and_in_no_circle() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let (pictures, mut count) = (pictures(), 0);
    for (folder, floors) in &pictures {
        let (mut files, mut uses) = (Vec::new(), HashMap::<String, HashSet<String>>::new());
        sources(&root.join(folder), &mut files);
        for file in files {
            let inside = file.strip_prefix(root).unwrap();
            let first = file.strip_prefix(root.join(folder)).unwrap().components().next().unwrap();
            let module = first.as_os_str().to_string_lossy().trim_end_matches(".rs").to_owned();
            // the front door, the pages and tests are no floors
            if ["lib", "main", "guide", "tests"].contains(&module.as_str()) {
                continue;
            }
            let floor = |name: &str| {
                let missing = || panic!("{}: {name} is not in src/guide/architecture.md: add it", inside.display());
                *floors.get(name).unwrap_or_else(missing)
            };
            let text = fs::read_to_string(&file).unwrap();
            let is_module = |name: &String| root.join(folder).join(format!("{name}.rs")).exists();
            for name in used(&text).into_iter().filter(is_module) {
                assert!(floor(&name) <= floor(&module), "{}: {module} may not use {name}", inside.display());
                if folder == "src" {
                    let alone = ["error", "grid", "exact"];
                    assert!(module != "exact" || alone.contains(&name.as_str()), "exact may not use {name}");
                }
                count += 1;
                if name != module {
                    uses.entry(module.clone()).or_default().insert(name);
                }
            }
            // others ask the grid, and need not know that processes share it
            let rows = ["elastic", "fft", "field", "grid", "slab", "world"];
            let knows = folder == "src" && used(&text).contains(&"slab".to_owned());
            assert!(!knows || rows.contains(&module.as_str()), "{}: slabs are for {rows:?}", inside.display());
            for (foreign, home) in [("rayon::", "par"), ("mpi::", "ranks")] {
                let free = folder != "src" || module == home;
                assert!(free || !text.contains(foreign), "{}: {foreign} is for {home}", inside.display());
            }
            uses.entry(module).or_default();
        }
        assert!(floors.keys().all(|name| uses.contains_key(name)), "{folder}: a module of the page is gone");
        let free = |uses: &HashMap<String, HashSet<String>>| {
            uses.iter().find(|(_, used)| used.iter().all(|name| !uses.contains_key(name))).map(|(name, _)| name.clone())
        };
        while let Some(module) = free(&uses) {
            uses.remove(&module);
        }
        assert!(uses.is_empty(), "{folder}: a circle in {uses:?}");
    }
    assert!(pictures.len() == 9 && count > 600, "{} pictures, {count} uses", pictures.len());
}

#[test]
fn files_that_contributors_are_sent_to_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = fs::read_to_string(root.join("CONTRIBUTING.md")).unwrap();
    let quoted = page.split('`').skip(1).step_by(2).flat_map(str::split_whitespace);
    let paths: Vec<_> = quoted.filter(|word| word.contains('/') && !word.starts_with("target")).collect();
    let lost: Vec<_> = paths.iter().filter(|path| !root.join(path).exists()).collect();
    assert!(lost.is_empty() && paths.len() > 40, "{lost:?} of {}", paths.len());
}
