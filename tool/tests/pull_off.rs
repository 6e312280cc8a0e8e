//! The pull-off, end to end.

use crate::bench::{Bench, text};

const STICKY: &str = "--law exponential --work-of-adhesion 1e-4 --range 4e-3";

fn rough() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 64 --k-l 2 --k-s 8 --rms-slope 0.1 --quiet --out heights.npy");
    bench
}

#[test]
fn the_pull_off_is_enclosed_and_reported() {
    let bench = rough();
    let find = |arguments: &str| bench.reported(&format!("pull-off --heights heights.npy {STICKY} {arguments}"));
    let (quick, close) = (find(""), find("--rtol 1e-3"));
    for (report, rtol) in [(&quick, 0.02), (&close, 1e-3)] {
        let [borne, lost] = ["pull_off_pressure", "lost_pressure"].map(|key| report[key].as_f64().unwrap());
        assert!(0.0 < borne && borne < lost && lost - borne <= rtol * lost, "{borne} {lost}");
        // on an area of 1
        assert_eq!((report["pull_off_force"].as_f64(), report["rtol"].as_f64()), (Some(borne), Some(rtol)));
        assert_eq!((&report["branch"], &report["reached"]), (&"unloading".into(), &true.into()));
        assert_eq!(report["last"]["mean_pressure"].as_f64(), Some(-borne));
    }
    // two brackets of one number
    assert!(quick["pull_off_pressure"].as_f64() <= close["lost_pressure"].as_f64());
    assert!(close["pull_off_pressure"].as_f64() <= quick["lost_pressure"].as_f64());

    // a tension that is borne is, and one that is not is not, in a solve
    let [borne, lost] = ["pull_off_pressure", "lost_pressure"].map(|key| quick[key].as_f64().unwrap());
    let solve = |pressure: f64, out: &str| {
        let load = format!("--mean-pressure={pressure} --no-pictures --quiet --out {out}");
        bench.run(&format!("solve --heights heights.npy {STICKY} {load}")).status.code()
    };
    assert_eq!((solve(-borne, "borne"), solve(-1.01 * lost, "lost")), (Some(0), Some(2)));
    assert_eq!(bench.report("lost")["status"], "detached");

    let said = bench.said(&format!("pull-off --heights heights.npy {STICKY} --preload 0.01"));
    assert!(said.contains("pull-off force") && said.contains("pressed to 0.01"), "{said}");
}

#[test]
fn what_has_no_pull_off_is_refused_and_one_not_found_is_named() {
    let bench = rough();
    for (arguments, parts) in [
        ("", &["pull-off: without adhesion surfaces bear no tension"][..]),
        ("--law exponential --work-of-adhesion 1e-4 --range 4e-3 --rtol 2", &["--rtol", "between 0 and 1"]),
        ("--law exponential --work-of-adhesion 1e-4 --range 4e-3 --branch both", &["--branch both"]),
        (
            "--law exponential --work-of-adhesion 1e-4 --range 4e-3 --wall penalty --wall-stiffness 9",
            &["springs:", "rigid wall"],
        ),
        ("--law exponential --work-of-adhesion 1e-4 --range 4e-3 --preload 1kPa", &["--preload", "unit"]),
    ] {
        bench.refused_with(&format!("pull-off --heights heights.npy {arguments}"), parts);
    }
    let output = bench.run(&format!("pull-off --heights heights.npy {STICKY} --max-iterations 2"));
    let told = text(&output.stderr);
    assert!(output.status.code() == Some(2) && told.contains("not converged"), "{told}");
}
