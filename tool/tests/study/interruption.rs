//! Studies that are killed, damaged, or changed.

use super::*;

#[test]
fn slices_jobs_and_interruptions_come_to_the_same_table() {
    let whole = Bench::new();
    whole.write("study.toml", MADE);
    whole.said("study study.toml --jobs 1 --quiet");
    let table = whole.bytes("study.csv");

    let slices = Bench::new();
    slices.write("study.toml", MADE);
    for slice in ["3/3", "1/3"] {
        slices.said(&format!("study study.toml --slice {slice} --jobs 3 --quiet"));
        assert!(!slices.path("study.csv").exists(), "cases are missing");
    }
    slices.said("study study.toml --slice 2/3 --quiet");
    assert!(slices.bytes("study.csv") == table);

    // a larger study solves what is new, in whatever order it stands; the rows of the other cases are not touched
    let larger = MADE.replace("\"1:2:2\"", "[3, 1, 2]");
    slices.write("study.toml", &larger);
    let mark = |bench: &Bench| {
        let names = bench.names("study.csv.cases");
        let time = |name: &String| bench.path("study.csv.cases").join(name).metadata().unwrap().modified().unwrap();
        names.iter().map(|name| (name.clone(), time(name))).collect::<Vec<_>>()
    };
    let before = mark(&slices);
    let said = slices.said("study study.toml");
    assert!(said.contains("2/2  case") && said.contains("18 rows of 6 cases in study.csv"), "{said}");
    let after = mark(&slices);
    assert!(after.len() == 12 && before.iter().all(|known| after.contains(known)));
    let rows = |table: &[u8]| {
        let table = text(table);
        let rows: Vec<_> = table.lines().skip(1).map(|row| row.split_once(',').unwrap().1.to_owned()).collect();
        rows
    };
    assert_eq!(rows(&slices.bytes("study.csv"))[6..], rows(&table)[..]);
    // and one with another option solves all
    slices.write("study.toml", &larger.replace("[make]", "[solver]\ntolerance = 1e-4\n[make]"));
    assert!(slices.said("study study.toml --list").lines().take(6).all(|line| line.contains("to do")));
}

#[test]
fn damaged_cases_are_solved_again() {
    let bench = Bench::new();
    // steep, for warnings
    bench.write("study.toml", &MADE.replace("rms-slope = 0.1", "rms-slope = 0.7"));
    let study = |code| {
        let output = bench.run("study study.toml --quiet");
        assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
        text(&output.stderr)
    };
    study(0);
    let [table, warnings] = ["study.csv", "study.csv.warnings.txt"].map(|name| bench.bytes(name));
    let folder = bench.path("study.csv.cases");
    let names: Vec<_> = bench.names("study.csv.cases");
    let cases: Vec<_> = names.iter().filter(|name| name.ends_with(".csv")).collect();
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let write = |name: &str, content: &[u8]| std::fs::write(folder.join(name), content).unwrap();
    let mut damaged = 0;
    let mut check = |damage: &dyn Fn(), said: usize| {
        damage();
        let stderr = study(0);
        let again = stderr.lines().filter(|line| line.contains("its rows were damaged, and it was solved again"));
        assert_eq!(again.count(), said, "{stderr}");
        assert!(bench.bytes("study.csv") == table && bench.bytes("study.csv.warnings.txt") == warnings);
        assert_eq!(bench.names("study.csv.cases"), names);
        damaged += 1;
    };
    let case = cases[1].as_str();
    let (rows, lines) = (read(case), text(&read(case)).lines().count());
    assert_eq!(lines, 4);
    for kept in [rows.len() - 1, rows.len() - 40, rows.len() / 2, 10] {
        check(&|| write(case, &rows[..kept]), 1);
    }
    let whole = text(&rows);
    for left in 0..lines {
        let without: String =
            whole.lines().enumerate().filter(|(k, _)| *k != left).map(|(_, line)| format!("{line}\n")).collect();
        check(&|| write(case, without.as_bytes()), 1);
    }
    for at in (0..rows.len()).step_by(rows.len() / 10) {
        let mut changed = rows.clone();
        changed[at] ^= 1;
        check(&|| write(case, &changed), 1);
    }
    check(&|| write(case, &[&rows[..], &rows[rows.len() - 30..]].concat()), 1);
    check(&|| write(case, &read(cases[0])), 1);
    check(&|| write(&format!("{case}.warnings.txt"), b"steep [1]: of nothing\n"), 1);
    check(&|| write(&format!("{case}.sum"), b"0 0\n"), 1);
    check(&|| std::fs::remove_file(folder.join(case)).unwrap(), 0);
    check(&|| write(case, b""), 0);
    assert!(damaged > 20);
}

#[test]
fn a_case_comes_to_the_same_rows_from_whatever_an_end_in_its_middle_leaves() {
    let bench = Bench::new();
    bench.write("study.toml", &MADE.replace("\"1:2:2\"", "[2]").replace("[[vary.adhesion]]\nlaw = \"none\"\n", ""));
    bench.said("study study.toml --quiet");
    let table = bench.bytes("study.csv");
    let name = bench.names("study.csv.cases").into_iter().find(|name| name.ends_with(".csv")).unwrap();
    let [case, made] = [name.clone(), name.replace(".csv", ".npz")].map(|name| format!("study.csv.cases/{name}"));
    let [state, sum] = [".state", ".sum"].map(|ending| format!("{case}{ending}"));
    let [done, checksum] = [&case, &sum].map(|name| bench.bytes(name));
    // the state after the first two rows, as an interrupted run leaves it
    std::fs::remove_file(bench.path(&case)).unwrap();
    let surface = format!("surface --size 24 --k-l 2 --k-s 8 --rms-slope 0.1 --seed 2 --quiet --out {made}");
    let law = "--law exponential --work-of-adhesion 1e-4 --range 1e-2";
    bench.said(&surface);
    bench.said(&format!("sweep --heights {made} {law} --mean-pressures 1e-3:1e-2:3:log --quiet --out {case}"));
    assert!(bench.bytes(&case) == done);
    std::fs::remove_file(bench.path(&case)).unwrap();
    let loads = format!("1e-3,{}", 1e-3 * f64::sqrt(10.0));
    bench.said(&format!("sweep --heights {made} {law} --mean-pressures {loads} --force --quiet --out {case}"));
    let [rows, saved] = [&case, &state].map(|name| bench.bytes(name));
    assert!(rows == done[..rows.len()] && rows.len() < done.len());
    let zeros = |bytes: &[u8], from: usize| [&bytes[..from], &vec![0; bytes.len() - from]].concat();
    for (rows, saved, checksum, again) in [
        // the process ends, with more rows than in its state, or before it has one
        (&rows[..], &saved[..], None, false),
        (&done, &saved, None, false),
        (&[&rows[..], b"7,8\n9,10\n11"].concat(), &saved, None, false),
        (&done[..done.len() - 9], b"", None, false),
        (&done, b"", None, false),
        // the power fails, before all or any of them is on the disk
        (&rows[..rows.len() - 1], &saved, None, true),
        (&zeros(&rows, rows.len() - 20), &saved, None, true),
        (&zeros(&rows, 0), &saved, None, true),
        (&rows, &saved[..saved.len() / 2], None, true),
        (&rows, &zeros(&saved, saved.len() / 4), None, true),
        (&done, b"", Some(&b""[..]), true),
        (&zeros(&done, 40), b"", Some(&checksum), true),
        (b"", b"", Some(&checksum), false),
    ] {
        for (name, content) in
            [(&case, Some(rows)), (&state, Some(saved).filter(|saved| !saved.is_empty())), (&sum, checksum)]
        {
            let _ = std::fs::remove_file(bench.path(name));
            content.map_or(Ok(()), |content| std::fs::write(bench.path(name), content)).unwrap();
        }
        assert!(bench.said("study study.toml --list").contains("0 of 1 cases are done"));
        let stderr = text(&bench.run("study study.toml --quiet").stderr);
        assert_eq!(stderr.contains("its rows were damaged, and it was solved again"), again, "{stderr}");
        assert!(bench.bytes("study.csv") == table && bench.bytes(&case) == done && !bench.path(&state).exists());
    }
}

#[test]
fn files_vary_too_and_a_changed_file_is_another_case() {
    let bench = Bench::new();
    for (name, seed) in [("a,b.npy", 1), ("c.npy", 2)] {
        bench.said(&format!("surface --size 16 --k-l 2 --k-s 6 --rms-slope 0.1 --seed {seed} --quiet --out {name}"));
    }
    let study = "command = \"sweep\"\nout = \"table.jsonl\"\n[surface]\nlengths = [1, 1]\n[loads]\nmean-gaps = 0.006\n\
                 [vary]\nheights = [\"a,b.npy\", \"c.npy\"]\nmodulus = [1, 2.5]\n";
    bench.write("study.toml", study);
    bench.said("study study.toml --quiet");
    let rows: Vec<serde_json::Value> =
        bench.read("table.jsonl").lines().map(|row| serde_json::from_str(row).unwrap()).collect();
    assert_eq!((rows.len(), &rows[1]["heights"], &rows[1]["modulus"]), (4, &"a,b.npy".into(), &2.5.into()));
    assert_eq!(rows[2]["case"], 3);
    // pressures go with the modulus
    let ratio = rows[1]["mean_contact_pressure"].as_f64().unwrap() / rows[0]["mean_contact_pressure"].as_f64().unwrap();
    assert!((ratio - 2.5).abs() < 1e-5, "{ratio}");
    bench.write("csv.toml", &study.replace("table.jsonl", "table.csv"));
    bench.said("study csv.toml --quiet");
    let table = bench.read("table.csv");
    let [header, row] = [0, 1].map(|line| table.lines().nth(line).unwrap());
    assert!(
        header.starts_with("case,control,") && row.starts_with("1,mean-gap,") && row.contains("\"a,b.npy\""),
        "{row}"
    );
    // ranges with units, in the digits that one would write
    let range = study.replace("[1, 1]", "[\"1um\", \"1um\"]").replace("[1, 2.5]", "\"1GPa:3GPa:3\"");
    bench.write("units.toml", &range.replace("mean-gaps = 0.006", "mean-gaps = \"6nm\""));
    let listed = bench.said("study units.toml --list");
    assert!(listed.contains("2  to do  heights a,b.npy, modulus 2GPa"), "{listed}");
    // some begin as an exponent does
    bench.write(
        "units.toml",
        &range.replace("mean-gaps = 0.006", "mean-gaps = \"6nm\"").replace("1GPa:3GPa:3\"", "1eV/nm3:3eV/nm3:3\""),
    );
    assert!(bench.said("study units.toml --list").contains("modulus 2eV/nm3"));
    for wrong in ["1GPa:3MPa:3", "1GPa:3:3", "one:two:3"] {
        bench.write("wrong.toml", &range.replace("1GPa:3GPa:3", wrong));
        bench.refused_with("study wrong.toml", &["vary.modulus", "same unit"]);
    }
    bench.said("surface --size 16 --k-l 2 --k-s 6 --rms-slope 0.1 --seed 3 --quiet --force --out c.npy");
    assert!(bench.said("study study.toml --list").contains("2 of 4 cases are done"));
}
