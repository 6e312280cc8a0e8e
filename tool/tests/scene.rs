//! Scene files, reports as JSON and completions, end to end.

use std::fs;

use crate::bench::{Bench, text};
use serde_json::Value;

const ADHESION: &str = "--law exponential --work-of-adhesion 1e-4 --range 4e-3";

const FIELDS: [&str; 4] = ["gap.npy", "pressure.npy", "contact_pressure.npy", "scene.toml"];

/// A folder with a rough surface in it.
fn rough() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 32 --k-l 2 --k-s 10 --rms-height 0.01 --quiet --out heights.npy");
    bench
}

#[test]
fn a_solve_leaves_a_scene_that_repeats_it() {
    let bench = rough();
    bench.said(&format!("solve --heights heights.npy --lengths 1 1 --mean-pressure 0.01 {ADHESION} --out a/first"));
    let scene = bench.read("a/first/scene.toml");
    for line in [
        "command = \"solve\"",
        "[surface]\nheights = \"../../heights.npy\"\nlengths = [1.0, 1.0]\nmodulus = 1.0\n",
        "[load]\nmean-pressure = 0.01\n",
        "[adhesion]\nlaw = \"exponential\"\nwork-of-adhesion = 0.0001\nrange = 0.004\n",
        "[output]\nout = \".\"\n",
    ] {
        assert!(scene.contains(line), "{scene}");
    }
    bench.said("run a/first/scene.toml --out second --quiet");
    for name in FIELDS.iter().take(3) {
        assert!(bench.bytes(&format!("a/first/{name}")) == bench.bytes(&format!("second/{name}")), "{name}");
    }
    // in its own place only with force, and then it remains what it was
    let refused = bench.refused("run a/first/scene.toml");
    assert!(refused.contains("a/first/report.json") && refused.contains("--force"), "{refused}");
    bench.said("run a/first/scene.toml --force --quiet");
    assert_eq!(bench.read("a/first/scene.toml"), scene);
    // also from elsewhere, and where the folder is a link
    bench.said("run second/scene.toml --out second/third --quiet");
    assert!(bench.read("second/third/scene.toml").contains("heights = \"../../heights.npy\""));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(bench.0.path().join("a/first"), bench.0.path().join("link")).unwrap();
        bench.said("run link/scene.toml --force --quiet");
        assert_eq!(bench.read("link/scene.toml"), scene);
    }
    // whatever the files
    bench.said("run second/scene.toml --format npz,vti --no-pictures --out archives --quiet");
    bench.said("run archives/scene.toml --out archives-again --quiet");
    for name in ["fields.npz", "fields.vti"] {
        assert!(bench.bytes(&format!("archives/{name}")) == bench.bytes(&format!("archives-again/{name}")), "{name}");
    }
    let absolute = bench.0.path().join("heights.npy");
    bench.said(&format!("solve --heights {} --mean-gap 0.02 --no-pictures --quiet --out absolute", absolute.display()));
    let scene = bench.read("absolute/scene.toml");
    assert!(scene.contains(&format!("heights = \"{}\"", absolute.display())) && scene.contains("no-pictures = true"));
}

#[test]
fn tables_and_surfaces_leave_scenes_that_repeat_them() {
    let bench = rough();
    for (command, out) in [
        ("sweep --heights heights.npy --mean-pressures 1e-3:0.01:3:log --fields fields", "sweep.csv"),
        ("sweep --heights heights.npy --mean-gaps 0.02,0.01", "sweep.jsonl"),
        ("surface --shape 24 16 --lengths 2 --k-s 6 --rms-slope 0.1 --seed 3 --psd psd.csv", "rough.npy"),
        (
            &format!("cycle --heights heights.npy {ADHESION} --mean-gaps 0.03,0.02 --steps 3 --plot loop.png"),
            "cycle.csv",
        ),
    ] {
        let scene = format!("{out}.scene.toml");
        bench.said(&format!("{command} --quiet --out {out}"));
        let (table, echo) = (bench.bytes(out), bench.read(&scene));
        let all = bench.names(".");
        // again, to another place, which must have all that the first one has
        fs::create_dir(bench.0.path().join("again")).unwrap();
        let others = ["fields", "psd", "plot"].map(|option| {
            let line = echo.lines().find_map(|line| line.strip_prefix(&format!("{option} = ")));
            line.map_or(String::new(), |name| format!("--{option} again/{}", name.trim_matches('"')))
        });
        bench.said(&format!("run {scene} --quiet --out again/{out} {}", others.join(" ")));
        assert!(bench.bytes(&format!("again/{out}")) == table, "{command}");
        // and in the same place, when all but the scene is gone
        for name in all.iter().filter(|name| **name != scene && !name.starts_with("heights")) {
            let path = bench.0.path().join(name);
            if path.is_dir() { fs::remove_dir_all(path).unwrap() } else { fs::remove_file(path).unwrap() }
        }
        bench.said(&format!("run {scene} --quiet"));
        assert!(bench.bytes(out) == table && bench.read(&scene) == echo, "{command}");
        fs::remove_dir_all(bench.0.path().join("again")).unwrap();
        for name in bench.names(".").iter().filter(|name| !name.starts_with("heights")) {
            let path = bench.0.path().join(name);
            if path.is_dir() { fs::remove_dir_all(path).unwrap() } else { fs::remove_file(path).unwrap() }
        }
    }
}

#[test]
fn a_scene_has_the_options_of_its_command_and_gives_way_to_those_beside_it() {
    let bench = rough();
    fs::create_dir(bench.0.path().join("scenes")).unwrap();
    let scene = "command = \"solve\"\nout = \"../results\"\nno-pictures = true\nforce = false\n\
                 [surface]\nheights = \"../heights.npy\"\nlengths = [2.0, 3]\nmodulus = 10\n[load]\nmean-gap = 0.02\n";
    bench.write("scenes/press.toml", scene);
    let report = bench.reported("run scenes/press.toml");
    assert_eq!((report["modulus"].as_f64(), report["control"].as_str()), (Some(10.0), Some("mean-gap")));
    assert_eq!(report["lengths"], serde_json::json!([2.0, 3.0]));
    assert_eq!(
        bench.names("results"),
        ["contact_pressure.npy", "gap.npy", "pressure.npy", "report.json", "scene.toml"]
    );
    // the other load takes the place of the one in the scene, and files are relative to where one is
    let report = bench.reported("run scenes/press.toml --mean-pressure=0.01 --modulus 20 --lengths 1 --out other");
    assert_eq!((report["modulus"].as_f64(), report["control"].as_str()), (Some(20.0), Some("mean-pressure")));
    assert_eq!(report["lengths"], serde_json::json!([1.0, 1.0]));
    assert_eq!(bench.names("other").len(), 5);
    // without adhesion there are no parameters of it
    bench.said(&format!("solve --heights heights.npy --mean-gap 0.02 {ADHESION} --quiet --out sticky"));
    for none in ["--law none", "--law=none"] {
        let report = bench.reported(&format!("run sticky/scene.toml {none} --out bare --force"));
        assert_eq!((report["law"].as_str(), &report["range"]), (Some("none"), &Value::Null));
    }
    assert!(bench.refused("run sticky/scene.toml --law dupre").contains("exponential"));
    // numbers, words and lists for a list of loads
    for loads in ["[0.02, 0.01]", "[\"0.02:0.01:2\"]", "\"0.02,0.01\""] {
        let scene = format!("command = \"sweep\"\nheights = \"heights.npy\"\nmean-gaps = {loads}\nout = \"s.csv\"\n");
        bench.write("sweep.toml", &scene);
        bench.said("run sweep.toml --force");
        assert_eq!(bench.read("s.csv").lines().count(), 3, "{loads}");
    }
}

#[test]
fn bad_scenes_are_refused_on_one_line() {
    let bench = rough();
    let solve = "command = \"solve\"\nheights = \"heights.npy\"\nout = \"results\"\n";
    for (lines, parts) in [
        ("", vec!["required", "--mean-gap", "--mean-pressure"]),
        ("mean-gap = 0.02\nmodulu = 3", vec!["'--modulu'", "did you mean", "'--modulus'"]),
        ("mean_gap = 0.02", vec!["'--mean_gap'", "similar", "'--mean-gap'"]),
        ("mean-gap = \"much\"", vec!["is much", "--mean-gap", "a number"]),
        ("mean-gap = -1", vec!["is -1", "--mean-gap", "zero or positive"]),
        ("mean-gap = true", vec!["mean-gap is true", "a number"]),
        ("mean-gap = [1, 2]", vec!["'1,2'", "--mean-gap"]),
        ("mean-gap = 1\nmean-pressure = 1", vec!["cannot be used with"]),
        ("mean-gap = 1\nlaw = \"dupre\"", vec!["dupre", "exponential"]),
        ("mean-gap = 1\nlengths = [1, 2, 3]", vec!["lengths has 3", "2 at most"]),
        ("mean-gap = 1\nnested = \"yes\"", vec!["nested is \"yes\"", "true or false"]),
        ("mean-gap = 1\ninitial-gap = 1", vec!["initial-gap is 1", "a name"]),
        ("mean-gap = 1\nhelp = true", vec!["help", "no option"]),
        ("mean-gap = 1\n\"out=x\" = 1", vec!["out=x", "no option"]),
        ("mean-gap = 1\n[solvr]\ntolerance = 1", vec!["[solvr]", "[surface], [body], [load], [adhesion]"]),
        ("mean-gap = 1\n[load]\nmean-gap = 1", vec!["mean-gap", "twice"]),
        ("mean-gap = 1\nmean-gap = 1", vec!["line 5", "duplicate"]),
        ("mean-gap = ", vec!["line 4", "not TOML"]),
    ] {
        bench.write("bad.toml", &format!("{solve}{lines}\n"));
        let refused = bench.refused("run bad.toml");
        assert!(refused.contains("bad.toml") && parts.iter().all(|part| refused.contains(part)), "{lines}: {refused}");
    }
    for (content, part) in [
        ("", "add command"),
        ("out = \"x\"", "add command"),
        ("command = \"solv\"", "one of demo, solve"),
        ("command = \"run\"", "one of demo, solve"),
        ("command = 3", "one of demo, solve"),
        ("command", "line 1"),
    ] {
        bench.write("bad.toml", content);
        let refused = bench.refused("run bad.toml");
        assert!(refused.contains("bad.toml") && refused.contains(part), "{content}: {refused}");
    }
    for (arguments, parts) in [
        ("run nothing.toml", vec!["nothing.toml", "does not exist"]),
        ("run heights.npy", vec!["heights.npy", "no text"]),
        ("run .", vec!["a folder"]),
        ("run", vec!["<SCENE>"]),
    ] {
        let refused = bench.refused(arguments);
        assert!(parts.iter().all(|part| refused.contains(part)), "{arguments}: {refused}");
    }
    // what was given with a scene is not its fault
    bench.write("good.toml", &format!("{solve}mean-gap = 0.02\n"));
    for (options, part) in [("--modulus soft", "is soft"), ("--colour red", "--colour"), ("--modulus=0", "is 0")] {
        let refused = bench.refused(&format!("run good.toml {options}"));
        assert!(!refused.contains("good.toml") && refused.contains(part), "{refused}");
    }
    assert_eq!(bench.names("."), ["bad.toml", "good.toml", "heights.npy", "heights.npy.scene.toml"]);
}

#[test]
fn scenes_that_were_written_by_hand_are_not_replaced() {
    let bench = rough();
    let scene = "# mine\ncommand = \"solve\"\nheights = \"heights.npy\"\nmean-gap = 0.02\nout = \".\"\n";
    bench.write("scene.toml", scene);
    for arguments in ["run scene.toml", "run scene.toml --force"] {
        let refused = bench.refused(arguments);
        assert!(refused.contains("was not written by asperity") && refused.contains("--out"), "{refused}");
    }
    assert_eq!(bench.read("scene.toml"), scene);
    bench.write("sweep.csv.scene.toml", scene);
    let refused = bench.refused("sweep --heights heights.npy --mean-gaps 0.02 --force --out sweep.csv");
    assert!(refused.contains("was not written by asperity"), "{refused}");
    // of two surfaces that differ, the scene of the first one remains
    fs::remove_file(bench.0.path().join("heights.npy")).unwrap();
    let refused = bench.refused("surface --size 16 --k-s 6 --rms-slope 1 --out heights.npy");
    assert!(refused.contains("heights.npy.scene.toml") && refused.contains("--force"), "{refused}");
    bench.said("surface --size 16 --k-s 6 --rms-slope 1 --out heights.npy --force");
    bench.said("run heights.npy.scene.toml --force");
}

#[test]
fn a_scene_can_name_what_has_no_hyphens() {
    let bench = rough();
    bench.write("measure.toml", "command = \"stats\"\nheights = \"heights.npy\"\nlengths = 2\n");
    assert_eq!(bench.said("run measure.toml"), bench.said("stats heights.npy --lengths 2"));
    assert!(bench.refused("run measure.toml --psd heights.npy").contains("is read by this run"));
}

#[test]
fn reports_are_one_document_of_what_is_written() {
    let bench = rough();
    let quick = "--heights heights.npy --threads 1";
    // what is in the folder is what is printed
    let printed = bench.reported(&format!("solve {quick} --mean-gap 0.02 --out same"));
    let written: Value = serde_json::from_str(&bench.read("same/report.json")).unwrap();
    assert_eq!(printed, written);
    // the last row of the table
    let report = bench.reported(&format!("sweep {quick} --mean-pressures 1e-3,1e-2 --out sweep.csv"));
    let table = bench.read("sweep.csv");
    let last = table.lines().last().unwrap().split(',').zip(table.lines().next().unwrap().split(','));
    for (cell, name) in last {
        let value = &report["last"][name];
        assert!(value.as_str() == Some(cell) || value.as_f64() == cell.parse().ok(), "{name}: {value} is not {cell}");
    }
    // not converged is in the report too
    let output = bench.run(&format!("solve {quick} --mean-gap 0.01 --max-iterations 1 --json --out unfinished"));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), report["status"].as_str()), (Some(2), Some("iteration-limit")));
}

#[test]
fn unstable_equilibria_can_be_left() {
    let bench = rough();
    bench.write("flat.txt", &"0\n".repeat(64));
    let flat =
        "--heights flat.txt --law exponential --work-of-adhesion 1e-3 --range 1e-2 --mean-gap 0.011 --no-pictures";
    // all else is silent, but that a flat surface is probably none
    let run = |arguments: &str| -> (Value, String) {
        let output = bench.run(&format!("{arguments} --json"));
        let (first, rest) = (text(&output.stderr), |text: &str| text.split_once('\n').unwrap().1.to_owned());
        assert!(first.starts_with("warning: flat: all heights are 0"), "{first}");
        (serde_json::from_slice(&output.stdout).unwrap(), rest(&first))
    };
    let (held, warning) = run(&format!("solve {flat} --stability --out held"));
    assert_eq!((held["stability"]["verdict"].as_str(), &held["departures"]), (Some("unstable"), &Value::Null));
    assert!(warning.contains("unstable") && warning.contains("--leave") && warning.lines().count() == 1, "{warning}");
    let (left, silence) = run("run held/scene.toml --leave --out left");
    assert_eq!(silence, "");
    assert_eq!(left["stability"]["verdict"], "stable");
    let departure = &left["departures"][0];
    assert_eq!(departure["eigenvalue"], held["stability"]["eigenvalue"]);
    assert!(departure["energy_drop"].as_f64().unwrap() > 0.0, "{left}");
    // from a stable one there is nowhere to go
    let (stable, silence) = run("run left/scene.toml --initial-gap left/gap.npy --out stays");
    assert_eq!(silence, "");
    assert_eq!(
        (stable["departures"].as_array().map(Vec::len), &stable["contact_nodes"]),
        (Some(0), &left["contact_nodes"])
    );
    assert!(bench.names("stays").contains(&"mode.npy".to_owned()));
}

#[test]
fn completions_know_commands_and_options() {
    let bench = rough();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = bench.said(&format!("completions {shell}"));
        for word in ["completions", "solve", "mean-pressure", "work-of-adhesion"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    let refused = bench.refused("completions tcsh");
    assert!(refused.contains("bash") && refused.contains("zsh"), "{refused}");
}

#[test]
fn there_are_no_colours_in_pipes() {
    let bench = rough();
    for arguments in ["--help", "solve --help", "solve", "solve --heights heights.npy --mean-gap 0.02 --out results"] {
        let output = bench.run(arguments);
        assert!(![output.stdout, output.stderr].concat().contains(&0x1b), "{arguments}");
    }
}
