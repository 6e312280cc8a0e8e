//! Files that are read and written.

use super::*;

/// Written by numpy 2.4, gsffile 0.5 and gwyfile 0.2: h = i + 10 j on 4 x 3 nodes of 2 by 3 µm, and [2, 1] is missing.
#[test]
fn files_of_others_have_their_heights_where_they_belong() {
    for (name, scale, lengths, unit) in [
        ("map.npz", 1.0, Some((2e-6, 3e-6)), Some("m")),
        ("map-deflated.npz", 1.0, Some((2.0, 3.0)), Some("\u{b5}m")),
        ("map.gsf", 1.0, Some((2e-6, 3e-6)), Some("m")),
        ("map.gwy", 1.0, Some((2e-6, 3e-6)), Some("m")),
        ("bare.gsf", 1.0, None, None),
        ("gwyddion.txt", 1e-9, Some((2e-6, 3e-6)), Some("m")),
        ("map.xyz", 1.0, Some((2.0, 3.0)), None),
    ] {
        let map = read_topography(corpus(name)).unwrap();
        assert_eq!((map.heights.dim(), map.missing(), map.unit.as_deref()), ((4, 3), 1, unit), "{name}");
        assert!(map.heights.is_standard_layout());
        for ((i, j), h) in map.heights.indexed_iter() {
            let expected = scale * (i as f64 + 10.0 * j as f64);
            assert!(
                if (i, j) == (2, 1) { h.is_nan() } else { (h - expected).abs() <= 1e-15 * expected },
                "{name}: {h} at {i}, {j}"
            );
        }
        assert_eq!(map.lengths.is_some(), lengths.is_some());
        if let (Some(found), Some(lengths)) = (map.lengths, lengths) {
            assert!((found.0 / lengths.0 - 1.0).abs() < 1e-12 && (found.1 / lengths.1 - 1.0).abs() < 1e-12, "{name}");
        }
    }
}

#[test]
fn all_formats_hold_the_same_fields() {
    let bench = Bench::new();
    for precision in ["f32", "f64"] {
        let heights = Array2::from_shape_fn((6, 4), |(i, j)| 0.01 * ((i * i + 2 * j) as f64).cos());
        write_npy(bench.path("h.npy"), &heights).unwrap();
        bench.said(&format!(
            "solve --heights h.npy --lengths 3 1 --mean-pressure 2e-3 --precision {precision} --law exponential \
             --work-of-adhesion 1e-5 --range 1e-2 --stability --format npy --format npz --format vti --no-pictures --out {precision}"
        ));
        let folder = bench.path(precision);
        let vti = fs::read(folder.join("fields.vti")).unwrap();
        let start = vti.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
        let head = text(&vti[..start]);
        assert!(
            head.contains(r#"WholeExtent="0 5 0 3 0 0" Origin="-1.5e0 -5e-1 0" Spacing="5e-1 2.5e-1 2.5e-1""#),
            "{head}"
        );
        let width = if precision == "f32" { 4 } else { 8 };
        assert_eq!(head.matches(if width == 4 { "Float32" } else { "Float64" }).count(), 4);
        assert!(vti.ends_with(b"</AppendedData>\n</VTKFile>\n"));
        let archive = fs::read(folder.join("fields.npz")).unwrap();
        for (k, name) in ["gap", "pressure", "contact_pressure", "mode"].into_iter().enumerate() {
            let field = read_field(folder.join(format!("{name}.npy"))).unwrap();
            let offset = k * (8 + 24 * width);
            assert!(head.contains(&format!(r#"Name="{name}" format="appended" offset="{offset}""#)), "{head}");
            let block = &vti[start + offset..];
            assert_eq!(block[..8], (24 * width as u64).to_le_bytes());
            for ((i, j), value) in field.indexed_iter() {
                // x runs fastest
                let bytes = &block[8 + (6 * j + i) * width..][..width];
                let found = match width {
                    4 => f64::from(f32::from_le_bytes(bytes.try_into().unwrap())),
                    _ => f64::from_le_bytes(bytes.try_into().unwrap()),
                };
                // the mode is f64 on its own, and in the precision of the others with them
                assert!(found == *value || name == "mode" && (found - value).abs() < 1e-6, "{name} at {i}, {j}");
            }
            // stored as the files are
            let npy = fs::read(folder.join(format!("{name}.npy"))).unwrap();
            assert!(name == "mode" || archive.windows(npy.len()).any(|window| window == npy), "{name}");
        }
        bench.refused_with(&format!("stats {precision}/fields.npz"), &["5 arrays", "named heights"]);
    }
    // what is there is not overwritten, whatever its format
    bench.refused_with(
        "solve --heights h.npy --mean-gap 1 --format vti --out f64",
        &["f64/report.json", "exists", "--force"],
    );
    bench.refused_with("solve --heights h.npy --mean-gap 1 --format hdf5 --out x", &["hdf5", "npy", "npz", "vti"]);
}

/// A Python with numpy: by `.ci/run` in the target folder, or any.
fn python() -> Option<PathBuf> {
    let target = Path::new(env!("CARGO_BIN_EXE_asperity")).ancestors().nth(2)?;
    let candidates = [target.join("numpy/bin/python"), PathBuf::from("python3")];
    let has_numpy = |python: &PathBuf| {
        Command::new(python).args(["-c", "import numpy"]).output().is_ok_and(|output| output.status.success())
    };
    candidates.into_iter().find(has_numpy)
}

/// Runs a script in the folder of a bench, and returns what it prints.
fn script(python: &Path, bench: &Bench, script: &str) -> String {
    let output = Command::new(python).current_dir(&bench.0).args(["-c", script]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

const SKIPPED: &str = "skipped: neither target/numpy/bin/python nor python3 has numpy; .ci/run installs it";

#[test]
fn scripts_of_the_page_on_python_run() {
    let Some(python) = python() else { return println!("{SKIPPED}") };
    let bench = Bench::new();
    let page = include_str!("../../../docs/program/numpy.md");
    let scripts: Vec<_> = page.split("```python\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let [before, after @ ..] = &scripts[..] else { panic!("{page}") };
    let solve = page.split("\nasperity ").nth(1).unwrap().split("\n```").next().unwrap().replace('\\', " ");
    script(&python, &bench, before);
    bench.said(&solve);
    assert!(script(&python, &bench, &after.concat()).starts_with("contact 0."));
    bench.said("solve --heights heights.npz --modulus 70e9 --mean-pressure 2e8 --format npz --out same");
    script(
        &python,
        &bench,
        "import numpy as np
assert (np.load('same/fields.npz')['gap'] == np.load('results/gap.npy')).all()",
    );
}

#[test]
fn numpy_reads_what_is_written_and_writes_what_is_read() {
    let Some(python) = python() else { return println!("{SKIPPED}") };
    let bench = Bench::new();
    let run = |lines: &str| script(&python, &bench, lines);
    // every kind of number, order and container: h = 3 i - j² is exact in all of them
    run("import numpy as np
h = np.array([[3 * i - j * j for j in range(4)] for i in range(7)])
for dtype in ['<f4', '>f4', '<f8', '>f8', 'i1', '<i2', '>i4', '<i8']:
    np.save(dtype.strip('<>') + ('b' if '>' in dtype else 'l') + '.npy', h.astype(dtype))
np.save('fortran.npy', np.asfortranarray(h.astype('f8')))
np.savez('one.npz', h)
np.savez_compressed('named.npz', heights=h, lengths=(7e3, 4e3), unit='m', other=np.zeros((9, 9)))
np.savetxt('text.txt', h, header='seven lines of four')");
    let expected = Array2::from_shape_fn((7, 4), |(i, j)| 3.0 * i as f64 - (j * j) as f64);
    let mut read = 0;
    for entry in fs::read_dir(&bench.0).unwrap() {
        let path = entry.unwrap().path();
        assert_eq!(read_field(&path).unwrap(), expected, "{}", path.display());
        read += 1;
    }
    assert_eq!(read, 12);
    let named = read_topography(bench.path("named.npz")).unwrap();
    assert_eq!((named.lengths, named.unit.as_deref()), (Some((7e3, 4e3)), Some("m")));

    // the other way, with the check that only the solution passes
    bench.said("solve --heights named.npz --modulus 1 --mean-gap 20 --format npy,npz --no-pictures --out r");
    bench.said("prepare named.npz --detrend plane --out back.npz");
    let said = run("import numpy as np, json
report = json.load(open('r/report.json'))
fields = np.load('r/fields.npz')
assert sorted(fields) == ['contact_pressure', 'gap', 'lengths', 'pressure'], sorted(fields)
for name in ['gap', 'pressure', 'contact_pressure']:
    alone = np.load('r/' + name + '.npy')
    assert alone.dtype == np.float64 and alone.shape == (7, 4)
    assert np.array_equal(fields[name], alone), name
assert list(fields['lengths']) == report['lengths']
assert abs(fields['gap'].mean() / 20 - 1) < 1e-12
assert (fields['gap'] * fields['contact_pressure'] == 0).all()
back = np.load('back.npz')
assert back['unit'] == 'm' and back['unit'].shape == () and list(back['lengths']) == [7e3, 4e3]
x, y = np.meshgrid(np.arange(7.0), np.arange(4.0), indexing='ij')
terms = np.stack([np.ones(28), x.ravel(), y.ravel()], 1)
h = np.load('one.npz')['arr_0'].ravel()
rest = h - terms @ np.linalg.lstsq(terms, h, rcond=None)[0]
assert abs(back['heights'].ravel() - rest).max() < 1e-13, abs(back['heights'].ravel() - rest).max()
print('same')");
    assert_eq!(said.trim(), "same");
}

#[test]
fn texts_of_instruments_are_read_by_what_the_options_say_of_them() {
    let bench = Bench::new();
    let channel = |title: &str, heights: &str| {
        format!("# Kanal: {title}\n# Breite: 3 \u{b5}m\n# H\u{f6}he: 2000 nm\n# Einheiten: nm\n{heights}\n")
    };
    let both = channel("Topo", "1 2 4\n4 6 3") + &channel("Topo zur\u{fc}ck", "9 2 1\n4 6 3");
    bench.write("two.txt", &both);
    bench.refused_with("prepare two.txt --out two.npz", &["2 channels (0 \"Topo\", 1 \"Topo zurück\")"]);
    bench.said("prepare two.txt --channel 1 --out two.npz");
    let map = read_topography(bench.path("two.npz")).unwrap();
    assert_eq!((map.heights.dim(), map.heights[[0, 1]], map.lengths), ((3, 2), 9e-9, Some((3e-6, 2e-6))));

    bench.write("words.txt", "Height (nm)\nof a tip\n1 2 lost\n4 7 6\n");
    bench.refused_with("stats words.txt", &["line 3: \"lost\"", "--missing-word \"lost\""]);
    let refused = ["line 1: \"Height\"", "--skip-lines 2"];
    bench.refused_with("prepare words.txt --missing-word lost --out words.npz", &refused);
    let said = bench.said("prepare words.txt --skip-lines 2 --missing-word lost --out words.npz");
    assert!(said.contains("2 x 3 heights, 1 missing"), "{said}");
    bench.refused_with("prepare words.npz --masked --out masked.npz", &["has no masks"]);

    bench.write("table.csv", "0,1.0,2,3,4,5\n1,5.0,2,7,3,1\n2,8.0,1,6,3,4\n");
    let said = text(&bench.run("stats table.csv").stderr);
    assert!(said.contains("warning: axes: the first line"), "{said}");
}
