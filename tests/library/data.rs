//! Settings, controls, reports and statistics as data.

use std::fmt::Debug;

use asperity::contact::ContactStatistics;
use asperity::solver::{Criterion, Method};
use asperity::stability::Verdict;
use asperity::*;
use serde_json::{Value, from_value, json, to_value};

/// Comes back from JSON as it was; returns what stands there.
#[track_caller]
fn comes_back<A>(value: &A) -> Value
where
    A: serde::Serialize + serde::de::DeserializeOwned + PartialEq + Debug,
{
    let text = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<A>(&text).unwrap(), value, "{text}");
    to_value(value).unwrap()
}

#[test]
fn reports_and_statistics_come_back() {
    let surface = Surface::wave_2d(Grid::new((24, 16), (1.0, 0.7)).unwrap(), 0.02, 1).unwrap();
    let law = Exponential::new(1e-5, 4e-3).unwrap();
    let mut free = Problem::new(&surface, Boussinesq::<f32>::new(*surface.grid(), 1.0).unwrap(), law).unwrap();
    let solution = Solver::default().solve(&mut free, Control::Approach(0.005)).unwrap();
    let report = comes_back(&solution.report);
    assert_eq!(
        (&report["status"], &report["wall"], &report["precision"]),
        (&json!("converged"), &json!("rigid"), &json!("f32"))
    );
    assert_eq!(report["boundary"]["free"]["window"], json!({ "shape": [24, 16], "lengths": [1.0, 0.7] }));
    assert_eq!(report["control"], json!({ "approach": 0.005 }));
    comes_back(&ContactStatistics::of(&solution).unwrap());
    let other = |name: &str, value: Value| {
        let mut other = report.clone();
        other[name] = value;
        from_value::<Report>(other).is_err()
    };
    assert!(other("wall", json!("soft")) && other("status", json!("done")) && !other("wall", json!("none")));
}

#[test]
fn settings_may_leave_out_what_is_the_default() {
    let settings = Settings::rey2017().tolerance(1e-8).branch(Branch::Loading);
    comes_back(&settings);
    let some = from_value::<Settings>(json!({ "branch": "unloading", "max_iterations": 30 })).unwrap();
    assert_eq!(some, Settings::default().branch(Branch::Unloading).max_iterations(30));
    assert!(from_value::<Settings>(json!({ "tolerence": 1e-8 })).is_err());
    assert!(from_value::<Grid>(json!({ "shape": [0, 4], "lengths": [1.0, 1.0] })).is_err());
}

#[test]
fn names_are_those_of_reports() {
    for method in [Method::Preconditioned, Method::Rey2017] {
        assert_eq!(comes_back(&method), method.name());
    }
    for criterion in [Criterion::EnergyNorm, Criterion::Complementarity] {
        assert_eq!(comes_back(&criterion), criterion.name());
    }
    for branch in [Branch::Loading, Branch::Unloading] {
        assert_eq!(comes_back(&branch), branch.name());
    }
    use Status::*;
    for status in [Converged, IterationLimit, Stalled, Stopped, Detached] {
        assert_eq!(comes_back(&status), status.name());
    }
    for verdict in [Verdict::Stable, Verdict::Unstable, Verdict::Undecided] {
        assert_eq!(comes_back(&verdict), verdict.name());
    }
    assert_eq!(comes_back(&Boundary::Periodic), Boundary::Periodic.name());
    let spring = Control::Spring { stiffness: 2.0, rest: -0.1 };
    for control in
        [Control::MeanGap(0.1), Control::MeanPressure(-0.1), Control::Force(3.0), Control::Approach(0.2), spring]
    {
        assert!(comes_back(&control).get(control.name()).is_some(), "{control:?}");
    }
}
