//! Studies: every combination of options as one table.

mod interruption;

use std::process::{Command, Stdio};

use crate::bench::{Bench, text};

const MADE: &str = r#"
command = "sweep"
out = "study.csv"
[loads]
mean-pressures = "1e-3:1e-2:3:log"
[make]
size = 24
k-l = 2
k-s = 8
rms-slope = 0.1
[vary]
seed = "1:2:2"
[[vary.adhesion]]
law = "none"
[[vary.adhesion]]
law = "exponential"
work-of-adhesion = 1e-4
range = 1e-2
"#;

/// The cells of a table by row.
fn cells(table: &str) -> Vec<Vec<&str>> {
    table.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn a_study_has_the_rows_of_the_sweeps_that_it_stands_for() {
    let bench = Bench::new();
    bench.write("study.toml", MADE);
    let listed = bench.said("study study.toml --list");
    assert!(listed.contains("4  to do  seed 2, law exponential, work_of_adhesion 0.0001, range 0.01"), "{listed}");
    assert_eq!(bench.names("."), ["study.toml"], "a list writes nothing");
    let report = bench.reported("study study.toml");
    let number = |key: &str| report[key].as_u64();
    assert_eq!(["cases", "done", "rows", "unconverged"].map(number), [Some(4), Some(4), Some(12), Some(0)]);
    let table = bench.read("study.csv");
    let rows = cells(&table);
    assert_eq!(rows[0][..2], ["case", "control"]);
    let column = |name: &str| rows[0].iter().position(|column| *column == name).unwrap();
    let named = |row: usize| ["case", "seed", "law", "work_of_adhesion", "range"].map(|name| rows[row][column(name)]);
    assert_eq!(named(1), ["1", "1", "none", "", ""]);
    assert_eq!(named(12), ["4", "2", "exponential", "0.0001", "0.01"]);
    // the last of the cases by hand, but for the name of its surface
    bench.said("surface --size 24 --k-l 2 --k-s 8 --rms-slope 0.1 --seed 2 --quiet --out second.npz");
    bench.said(
        "sweep --heights second.npz --law exponential --work-of-adhesion 1e-4 --range 1e-2 \
         --mean-pressures 1e-3:1e-2:3:log --quiet --out second.csv",
    );
    let by_hand = bench.read("second.csv");
    let by_hand = cells(&by_hand);
    let surface = by_hand[0].iter().position(|column| *column == "heights").unwrap();
    for (row, expected) in rows.iter().take(1).chain(&rows[10..]).zip(&by_hand) {
        let expected: Vec<_> = (0..expected.len()).filter(|k| *k != surface).map(|k| expected[k]).collect();
        assert_eq!(row[1..], expected[..]);
    }
    // nothing is left of what it takes to continue
    let kept = bench.names("study.csv.cases");
    let of = |ending| kept.iter().filter(|name| name.ends_with(ending)).count();
    assert_eq!((kept.len(), of(".csv"), of(".csv.sum")), (8, 4, 4), "{kept:?}");
}

#[test]
fn the_chart_of_a_study_names_its_curves_by_what_varies() {
    let bench = Bench::new();
    // six combinations, each of two surfaces
    let vary = "seed = [1, 2]\nhurst = [0.4, 0.6, 0.8]\nwork-of-adhesion = [\"20mJ/m2\", \"40mJ/m2\"]\n";
    let (made, _) = MADE.split_once("[vary]").unwrap();
    let made = made.replace("size = 24", "size = 24\nlengths = \"1um\"").replace("1e-3:1e-2", "1MPa:10MPa");
    let surface = "[surface]\nmodulus = \"1GPa\"\n[adhesion]\nlaw = \"exponential\"\nrange = \"20nm\"\n";
    bench.write("study.toml", &format!("{made}{surface}[vary]\n{vary}"));
    bench.run("study study.toml --plot study.svg --quiet");
    bench.said("report study.csv");
    for picture in ["study.svg", "study.csv.html"] {
        let picture = bench.read(picture);
        // three colours and two dashes, one of them solid
        for name in ["hurst 0.4", "hurst 0.8", "work of adhesion 20 mJ/m²", "work of adhesion 40 mJ/m²"] {
            assert!(picture.contains(&format!(">{name}<")), "{name}");
        }
    }
    bench.refused_with("study study.toml --plot study.jpg", &["study.jpg", ".png, .svg or .pdf"]);
}

#[test]
fn a_study_of_cycles_has_objects_as_well() {
    let bench = Bench::new();
    let study = MADE.replace("sweep", "cycle").replace("\"1e-3:1e-2:3:log\"", "[1e-3, 1e-2]\nsteps = 3");
    bench.write("study.toml", &study);
    bench.said("study study.toml --quiet");
    bench.said("study study.toml --quiet --out study.jsonl");
    let objects: Vec<serde_json::Value> =
        bench.read("study.jsonl").lines().map(|row| serde_json::from_str(row).unwrap()).collect();
    let table = bench.read("study.csv");
    let rows = cells(&table);
    let at = rows[0].iter().position(|name| *name == "mean_gap").unwrap();
    assert_eq!(objects.len() + 1, rows.len());
    for (object, row) in objects.iter().zip(&rows[1..]) {
        assert_eq!(object["mean_gap"].as_f64(), row[at].parse().ok());
    }
    bench.refused_with("cycle --heights none.npy --mean-gaps 2,1 --out cycle.txt", &["cycle.txt", ".csv or .jsonl"]);
}

#[test]
fn a_study_of_solves_has_the_rows_of_sweeps_with_one_load() {
    let bench = Bench::new();
    let loads = "[loads]\nmean-pressures = \"1e-3:1e-2:3:log\"";
    let after = "leakage = true\nstiffness = true\nresistivities = [1, 2]\n[loads]\nmean-pressures = 2e-3";
    let sweep = MADE.replace(loads, after);
    let solve = sweep.replace("sweep", "solve").replace("study.csv", "solve.csv").replace("[loads]\n", "");
    bench.write("sweep.toml", &sweep);
    bench.write("solve.toml", &solve.replace("mean-pressures", "no-nested = true\nmean-pressure"));
    bench.said("study sweep.toml --quiet");
    bench.said("study solve.toml --quiet");
    let table = bench.read("solve.csv");
    assert_eq!(table, bench.read("study.csv"));
    let rows = cells(&table);
    let column = |name: &str| rows[0].iter().position(|column| *column == name).unwrap();
    let [lower, upper] = [column("transmissivity_x_lower"), column("transmissivity_x_upper")];
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    assert!((1..5).all(|row| number(row, lower) > 0.0 && number(row, upper) < 1.001 * number(row, lower)));
    assert!((1..5).all(|row| number(row, column("electrical_conductance")) > 0.0));
    // the load may vary, as what follows the solve, and contact fractions are searched for
    let fraction = solve.replace("mean-pressures = 2e-3", "contact-fraction = 0.1").replace("leakage = true\n", "");
    bench.write(
        "fraction.toml",
        &fraction.replace("[vary]", "[vary]\nstiffness = [true]").replace("stiffness = true\n", ""),
    );
    bench.said("study fraction.toml --quiet --force --out fraction.jsonl");
    let first: serde_json::Value = serde_json::from_str(bench.read("fraction.jsonl").lines().next().unwrap()).unwrap();
    assert_eq!((&first["wanted_contact_fraction"], &first["reached"]), (&0.1.into(), &true.into()));
}

#[test]
fn cases_with_different_columns_share_a_table() {
    let bench = Bench::new();
    for format in ["csv", "jsonl"] {
        let study = MADE.replace("study.csv", &format!("study.{format}"));
        // the law without a range has two columns more than any other
        bench.write("study.toml", &format!("{study}[[vary.adhesion]]\nlaw = \"jkr\"\nwork-of-adhesion = 1e-4\n"));
        assert_eq!(bench.reported("study study.toml")["rows"], 18);
    }
    let rows = bench.read("study.jsonl");
    let rows: Vec<serde_json::Value> = rows.lines().map(|row| serde_json::from_str(row).unwrap()).collect();
    let known = rows.iter().map(|row| row.as_object().unwrap()["jkr_contact_fraction"].is_f64());
    assert!(known.eq(rows.iter().map(|row| row["law"] == "jkr")));
    let table = bench.read("study.csv");
    let table = cells(&table);
    let names: Vec<_> = rows[0].as_object().unwrap().keys().collect();
    assert_eq!(table[0], names);
    assert!(table.iter().all(|row| row.len() == names.len()));
    assert!(table[1].ends_with(&["", ""]) && !table[18].ends_with(&[""]), "{table:?}");
    // but not with numbers in different units
    let units =
        "[[vary.adhesion]]\nlaw = \"exponential\"\nwork-of-adhesion = \"1J/m2\"\nrange = \"2cm\"\nmodulus = \"1kPa\"\n";
    let study = MADE.replace("mean-pressures", "reduced-pressures").replace("[vary]\nseed = \"1:2:2\"\n", "");
    let begin = study.find("[[vary.adhesion]]\nlaw = \"exponential\"").unwrap();
    bench.write("units.toml", &format!("{}{units}", &study[..begin]));
    let told = ["has control_value [Pa] and not control_value", "in all cases, or in none"];
    bench.refused_with("study units.toml --quiet --out units.csv", &told);
}

#[test]
fn a_study_of_pull_offs_has_the_keys_of_their_reports() {
    let bench = Bench::new();
    let study = MADE.replace("sweep", "pull-off").replace("[loads]\nmean-pressures = \"1e-3:1e-2:3:log\"\n", "");
    let study =
        study.replace("[[vary.adhesion]]\nlaw = \"none\"\n", "").replace("[make]", "[load]\nrtol = 0.1\n[make]");
    bench.write("study.toml", &study);
    let report = bench.reported("study study.toml --out study.jsonl");
    assert_eq!((&report["rows"], &report["unconverged"]), (&2.into(), &0.into()));
    bench.said("study study.toml --quiet");
    let table = bench.read("study.csv");
    assert!(table.starts_with("case,pull_off_pressure,pull_off_force,limit_pressure"), "{table}");
    bench.said("surface --size 24 --k-l 2 --k-s 8 --rms-slope 0.1 --seed 2 --quiet --out second.npz");
    let law = "--law exponential --work-of-adhesion 1e-4 --range 1e-2";
    let expected = bench.reported(&format!("pull-off --heights second.npz {law} --rtol 0.1"));
    let row: serde_json::Value = serde_json::from_str(bench.read("study.jsonl").lines().nth(1).unwrap()).unwrap();
    for key in [
        "pull_off_pressure",
        "pull_off_force",
        "limit_pressure",
        "limit_force",
        "limit_error",
        "lost_pressure",
        "reached",
        "branch",
        "solves",
        "operator_applications",
    ] {
        assert_eq!(row[key], expected[key], "{key}");
    }
    for key in ["mean_gap", "mean_pressure", "contact_fraction", "corrected_contact_fraction", "status"] {
        assert_eq!(row[key], expected["last"][key], "{key}");
    }
    // a search that has not come to its end is counted, and says so
    bench.write(
        "short.toml",
        &study.replace("study.csv", "short.csv").replace("rtol = 0.1", "rtol = 0.1\n[solver]\nmax-iterations = 3"),
    );
    let output = bench.run("study short.toml --quiet");
    let said = text(&output.stderr);
    assert!(output.status.code() == Some(2) && said.contains("2 rows not converged"), "{said}");
}

#[test]
fn threads_do_not_change_a_byte() {
    // large enough for several threads of a solve
    let study = MADE.replace("size = 24", "size = 160").replace("\"1:2:2\"", "[1]");
    let table = |jobs: &str, threads: &str| {
        let bench = Bench::new();
        bench.write("study.toml", &study);
        let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
        command.current_dir(bench.path(".")).env("RAYON_NUM_THREADS", threads).args([
            "study",
            "study.toml",
            "--jobs",
            jobs,
        ]);
        assert!(command.stdout(Stdio::null()).status().unwrap().success());
        let cases = bench.names("study.csv.cases").into_iter().map(|name| format!("study.csv.cases/{name}"));
        cases.chain(["study.csv".to_owned()]).map(|name| bench.bytes(&name)).collect::<Vec<_>>()
    };
    let one = table("1", "1");
    assert!([("1", "3"), ("2", "1"), ("2", "4")].iter().all(|(jobs, threads)| table(jobs, threads) == one));
}

#[test]
fn rows_that_do_not_converge_are_counted() {
    let bench = Bench::new();
    bench.write("study.toml", &MADE.replace("[make]", "[solver]\nmax-iterations = 1\n[make]"));
    let output = bench.run("study study.toml --quiet");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("12 rows not converged") && bench.read("study.csv").contains("iteration-limit"), "{said}");
}

#[test]
fn studies_that_cannot_be_are_refused_before_anything_is_solved() {
    let bench = Bench::new();
    let base = "command = \"sweep\"\nout = \"study.csv\"\n[loads]\nmean-gaps = 0.02\n[make]\nsize = 16\nk-s = 6\nrms-slope = 0.1\n";
    let vary = |what: &str| format!("{base}[vary]\n{what}\n");
    let solve =
        |what: &str| base.replace("sweep", "solve").replace("[loads]\nmean-gaps", &format!("{what}\n[load]\nmean-gap"));
    for (study, parts) in [
        ("[loads]".to_owned(), &["study.toml", "add command"][..]),
        (base.replace("sweep", "stats"), &["it must be one of solve, sweep, cycle, pull-off"]),
        (
            base.replace("sweep", "solve").replace("loads", "load"),
            &["mean-gaps is no option", "did you mean mean-gap?"],
        ),
        (base.replace("out = \"study.csv\"\n", ""), &["names no table", "out = \"study.csv\""]),
        (base.replace("study.csv", "study.txt"), &["study.txt", ".csv or .jsonl"]),
        (base.replace("sweep", "cycle").replace("study.csv", "study.txt"), &["study.txt", ".csv or .jsonl"]),
        (vary("seed = 3"), &["vary.seed is 3", "list"]),
        (vary("seed = []"), &["vary.seed is []"]),
        (vary("seed = [1, { law = \"none\" }]"), &["vary.seed has both"]),
        (vary("size = [16, 24]"), &["size is there twice"]),
        (vary("seeds = [1, 2]"), &["study.toml: seeds is no option of surface or sweep", "did you mean seed?"]),
        (base.replace("k-s", "ks"), &["ks is no option", "did you mean k-s?"]),
        (base.replace("mean-gaps", "mean-gasp"), &["mean-gasp", "did you mean mean-gaps?"]),
        (vary("zzz = [1, 2]"), &["zzz is no option", "remove it"]),
        (vary("seed = [1, 2]").replace("[vary]", "[varry]"), &["[varry] is no section", "did you mean [vary]?"]),
        (base.replace("out =", "ouput ="), &["add out = \"study.csv\" in the place of ouput"]),
        (vary("rms-height = [0.1]"), &["case 1", "--rms-height", "--rms-slope"]),
        (vary("modulus = [0.5, -2]"), &["case 2", "--modulus"]),
        (vary("threads = [1, 2]"), &["threads is no option of a study"]),
        (vary("dpi = [75, 150]"), &["dpi is no option of a study"]),
        (vary("psd = [\"a.csv\"]"), &["psd is no option of a study"]),
        (solve("percolation = true"), &["percolation is no option of a study"]),
        (base.replace("[make]", "force = true\n[make]"), &["force is no option of a study"]),
        (vary("seed = \"1:100000:100000\"\nmodulus = \"1:2:100000\""), &["more cases than the 1000000"]),
        (
            base.replace("[make]\nsize = 16\nk-s = 6\nrms-slope = 0.1", "[surface]\nheights = \"none.npy\""),
            &["none.npy"],
        ),
    ] {
        bench.write("study.toml", &study);
        bench.refused_with("study study.toml", parts);
        assert_eq!(bench.names("."), ["study.toml"], "{study}");
    }
    bench.write("study.toml", base);
    for slice in ["0/3", "4/3", "3", "a/b", "-1/2"] {
        bench.refused_with(&format!("study study.toml --slice {slice}"), &["--slice", "3/16"]);
    }
    bench.write("study.csv", "a table of mine\n");
    bench.refused_with("study study.toml", &["study.csv", "--force"]);
    assert_eq!(bench.read("study.csv"), "a table of mine\n");
    // a case that its command refuses is named, the others are solved, and no table is written
    bench.write("study.toml", &(vary("hurst = [0.5, 0.8]\nk-r = [5, 400]").replace("study.csv", "other.csv")));
    let output = bench.run("study study.toml --quiet");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    // the reason once
    let refusals = said.lines().filter(|line| line.contains(" is refused: ")).collect::<Vec<_>>();
    assert!(refusals.len() == 1 && refusals[0].contains(", k_r 400 is refused"), "{said}");
    assert!(said.contains("2 of 4 cases were refused, all as case "), "{said}");
    assert!(!bench.path("other.csv").exists());
    assert!(bench.said("study study.toml --list").contains("2 of 4 cases are done"));
}

/// The job scripts of the page `cluster`, with the words that Slurm gives its jobs.
#[cfg(unix)]
#[test]
fn the_job_scripts_of_the_documentation_come_to_the_table() {
    let bench = Bench::new();
    bench.write("study.toml", MADE);
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../src/guide/cluster.md");
    let page = std::fs::read_to_string(page).unwrap();
    let blocks = page.split("```sh\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let scripts: Vec<_> = blocks.filter(|block| block.starts_with("#!")).collect();
    let [slices, table] = scripts[..] else { panic!("{scripts:?}") };
    let tools = std::path::Path::new(env!("CARGO_BIN_EXE_asperity")).parent().unwrap();
    let path = std::env::join_paths(
        [tools.to_owned()].into_iter().chain(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default())),
    );
    let submit = |script: &str, task: usize| {
        let mut job = Command::new("sh");
        job.args(["-euc", script]).current_dir(bench.path(".")).env("PATH", path.as_ref().unwrap());
        job.env("SLURM_ARRAY_TASK_ID", task.to_string()).env("SLURM_ARRAY_TASK_COUNT", "3");
        let output = job.env("SLURM_CPUS_PER_TASK", "2").output().unwrap();
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()), "{script}");
        text(&output.stdout)
    };
    submit(slices, 1);
    submit(slices, 3);
    assert!(!bench.path("study.csv").exists());
    // the second task never ran
    let said = submit(table, 0);
    assert!(said.contains("1/1  case 2") && said.contains("12 rows of 4 cases in study.csv"), "{said}");
    submit(slices, 2);
}
