//! What the tool says to those who know its options by other names, and what completions offer.

use crate::bench::{Bench, text};

fn bench() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 16 --k-l 2 --k-s 6 --rms-slope 0.1 --quiet --out h.npy");
    bench
}

#[test]
fn other_words_for_options_get_the_one_that_is_meant_and_what_it_is() {
    let bench = bench();
    let (solve, sweep) = ("solve --heights h.npy --out r", "sweep --heights h.npy --out r.csv");
    for (command, parts) in [
        (
            format!("{solve} --pressure 0.1"),
            &["'--pressure'", "did you mean '--mean-pressure', mean external pressure"][..],
        ),
        (format!("{solve} --force 0.1"), &["'--force' takes no value", "did you mean '--normal-force', normal force"]),
        (format!("{solve} --force -3nN"), &["'--force' takes no value", "did you mean '--normal-force'"]),
        (format!("{solve} --force=5nN"), &["'--force' takes no value", "did you mean '--normal-force'"]),
        (
            format!("{solve} --mean-gap 1 --nu 0.3"),
            &["did you mean '--modulus', contact modulus E*", "Poisson's ratio"],
        ),
        (format!("{solve} --mean-gap 1 -E 3"), &["did you mean '--modulus'"]),
        (format!("{solve} --mean-gap 1 --friction 0.3"), &["knows no friction, docs/more/limits.md lists"]),
        (format!("{solve} --mean-gap 1 --adhesion morse"), &["did you mean '--law', adhesion law", ": none, jkr, "]),
        (
            format!("{solve} --mean-pressures 1,2"),
            &["did you mean '--mean-pressure',", "is an option of sweep, cycle and interface"],
        ),
        (format!("{solve} --mean-pressure 1,2"), &["a list is for sweep, cycle and interface, by '--mean-pressures'"]),
        (format!("{sweep} --mean-pressure 1"), &["did you mean '--mean-pressures',", "is an option of solve"]),
        // a list of one load that is wrong is no list for another command
        (format!("{sweep} --mean-pressures 1:2"), &["FROM:TO:COUNT or FROM:TO:COUNT:log; see --help"]),
        // several positions, or of what else a solve has one, are a study
        (
            format!("{sweep} --mean-pressures 1 --against h.npy --shifts 0:1:8"),
            &["'--shifts'", "'asperity study'", "by shift = \"FROM:TO:COUNT\" in its section [vary]"],
        ),
        (format!("{solve} --mean-pressure 1 --against h.npy --shift 0:1um:8"), &["'asperity study', by shift ="]),
        (format!("{solve} --mean-pressure 1 --poisson 0.3 --layer 1,2"), &["'asperity study', by layer ="]),
        (format!("{sweep} --approach 1"), &["did you mean '--approaches',"]),
        (format!("{sweep} --mean-pressures 1MPa-100MPa"), &["a range is FROM:TO:COUNT, such as 1MPa:100MPa:10 or"]),
        (format!("{solve} --mean-gap 1 --plot a.png"), &["'--plot' is an option of sweep, cycle, study and laws"]),
        (format!("{solve} --mean-gap 1 --lengths 2,3"), &["with spaces between, '--lengths 2 3'"]),
        ("solve h.npy --mean-gap 1 --out r".to_owned(), &["'--heights h.npy'"]),
        ("stats --heights h.npy".to_owned(), &["<FILE> is given without a name"]),
        ("solve press.toml".to_owned(), &["'asperity run press.toml'"]),
        ("press.toml".to_owned(), &["'asperity run press.toml'", "'asperity study press.toml'"]),
    ] {
        bench.refused_with(&command, parts);
    }
    // what no table knows keeps the likeness of clap
    bench.refused_with(&format!("{solve} --mean-gap 1 --heigths h.npy"), &["a similar argument exists: '--heights'"]);
}

#[test]
fn keys_of_scenes_and_studies_by_other_names_get_the_same() {
    let bench = bench();
    for (load, parts) in [
        ("pressure = 0.1", &["scene.toml: ", "'--pressure'", "did you mean '--mean-pressure'"][..]),
        ("force = \"5nN\"", &["scene.toml: ", "force is \"5nN\"", "did you mean 'normal-force', normal force"]),
        ("mean-pressures = [1, 2]", &["scene.toml: ", "did you mean '--mean-pressure',", "sweep, cycle and interface"]),
    ] {
        bench.write("scene.toml", &format!("command = \"solve\"\nout = \"r\"\nheights = \"h.npy\"\n{load}\n"));
        bench.refused_with("run scene.toml", parts);
    }
    bench.refused_with("study scene.toml", &["r: does not end in .csv", "'asperity run scene.toml'"]);
    let study =
        "command = \"sweep\"\nout = \"s.csv\"\nheights = \"h.npy\"\nmean-gaps = 0.02\n[vary]\nmodulus = [1, 2]\n";
    bench.write("study.toml", study);
    bench.refused_with("run study.toml", &["study.toml: has [vary]", "'asperity study study.toml'"]);
    bench.write("study.toml", &study.replace("modulus", "youngs-modulus"));
    bench.refused_with("study study.toml", &["youngs-modulus is no option", "did you mean modulus?"]);
}

#[cfg(unix)]
#[test]
fn completions_know_values_files_and_folders() {
    let bench = bench();
    std::fs::create_dir(bench.path("folder")).unwrap();
    bench.write("completions", &bench.said("completions bash"));
    bench.write(
        "complete",
        "source completions 2> /dev/null\nCOMP_WORDS=(asperity \"$@\")\nCOMP_CWORD=$#\ncompopt() { :; }\n\
         _asperity asperity \"${COMP_WORDS[-1]}\" \"${COMP_WORDS[-2]}\"\necho \"${COMPREPLY[@]}\"\n",
    );
    let offered = |words: &[&str]| {
        let mut shell = std::process::Command::new("bash");
        let output = shell.current_dir(bench.path(".")).arg("complete").args(words).output().unwrap();
        text(&output.stdout).trim().to_owned()
    };
    for (words, expected) in [
        (["solve", "--law", "m"], "maugis-dugdale morse"),
        (["sweep", "--boundary", ""], "periodic free"),
        (["solve", "--format", "n"], "npy npz"),
        (["prepare", "--detrend", ""], "mean plane quadric"),
        (["prepare", "--align-rows", "m"], "median median-difference"),
        (["solve", "--heights", "h.npy."], "h.npy.scene.toml"),
        // nothing where a number is wanted
        (["solve", "--mean-pressure", ""], ""),
    ] {
        assert_eq!(offered(&words), expected, "{words:?}");
    }
    // the words are those that the options take
    for option in ["--detrend mean", "--detrend plane", "--detrend quadric", "--align-rows median"] {
        bench.said(&format!("prepare h.npy {option} --quiet --force --out p.npy"));
    }
    for option in ["--align-rows median-difference", "--align-rows polynomial"] {
        bench.said(&format!("prepare h.npy {option} --quiet --force --out p.npy"));
    }
    assert!(bench.said("completions zsh").contains("made if needed]:DIR:_files -/'"));
}
