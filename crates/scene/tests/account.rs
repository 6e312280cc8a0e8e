//! A problem is posed and solved, and its account has the keys of every report.

use std::collections::HashSet;
use std::ops::ControlFlow;

use asperity::accuracy::Quantity;
use asperity::path::PathSettings;
use asperity::solver::Method;
use asperity::{Control, Grid, SelfAffine, Status, Surface};
use asperity_scene::theories::Theories;
use asperity_scene::{
    Account, Adhesion, AdhesionKeys, After, Answer, Boundary, Case, Elastic, Entries, Goal, GridErrors, GridLevel,
    Input, Inputs, Keys, Map, Maps, Number, Objects, OtherBranch, Outcome, Precision, Processes, Quantities,
    Refinement, Request, Row, Rows, Scene, Search, Session, Skin, Slopes, Solved, SolverKeys, Steadiness, SurfaceKeys,
    TableFile, Units, Way, check_finite, rows, shortfalls, worded,
};
use ndarray::Array2;
use serde::Deserialize;
use serde_json::{Value, json};

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// The names of the numbers that a report has.
fn names(lists: &[&[Number]]) -> Vec<&'static str> {
    lists.iter().flat_map(|list| list.iter()).filter(|number| number.is_reported).map(|number| number.name).collect()
}

fn scene() -> Scene {
    let adhesion = Adhesion {
        law: "exponential".to_owned(),
        work_of_adhesion: Some(2e-5),
        range: Some(8e-3),
        ..Adhesion::default()
    };
    Scene { adhesion, ..Scene::default() }
}

/// A rough surface with adhesion.
fn posed() -> Session<f64> {
    posed_by(&scene())
}

fn posed_by(scene: &Scene) -> Session<f64> {
    session(scene, SelfAffine::default().k_s(8.0).surface(Grid::square(32, 1.0).unwrap()).unwrap(), false).unwrap()
}

fn session(scene: &Scene, surface: Surface, is_strict: bool) -> Outcome<Session<f64>> {
    let lists = [SurfaceKeys::KEYS, AdhesionKeys::KEYS, SolverKeys::KEYS];
    let known = |name: &str| lists.into_iter().flatten().any(|key| key.name == name);
    let Value::Object(all) = json!(scene) else { unreachable!() };
    let typed = all.into_iter().filter(|(name, value)| known(name) && !value.is_null());
    let typed: Vec<_> = typed.map(|(name, value)| (name, Input::deserialize(value).unwrap())).collect();
    let given = Entries::read(&lists, typed)?;
    let case = Case::new(given, Quantities::default(), Objects::default(), Skin::Keywords)?;
    let (map, processes) = (Map::whole(None, surface.into()), Processes::start()?);
    Session::new(case.on(Maps::new(map), 1, &processes)?, is_strict, &processes)
}

fn solved(asked: &Request) -> Solved<f64> {
    posed().solve(asked, None, &mut |_, _, _| ControlFlow::Continue(())).unwrap()
}

fn next(rows: &mut Rows<f64>) -> Option<(Answer<f64>, Row)> {
    rows.next(&mut |_| ControlFlow::Continue(())).unwrap()
}

/// The contact stiffness alone.
fn stiff() -> After {
    After { stiffness: true, ..After::default() }
}

#[test]
fn the_inputs_of_a_report_describe_the_scene_of_its_run() {
    let elastic = Elastic { boundary: Boundary::Free, modulus: 2.0, ..Elastic::default() };
    let (tolerance, max_iterations) = (Some(1e-3), Some(7));
    let (method, precision) = (Method::Rey2017, Precision::F32);
    let run = Scene { elastic, method, precision, tolerance, max_iterations, ..scene() };
    assert_eq!(serde_json::from_value::<Scene>(json!(run.inputs((4, 4), (1.0, 1.0), 1))).unwrap(), run);
    assert_eq!(serde_json::from_value::<Scene>(json!(run)).unwrap(), run);
    let (settings, default) = (run.settings(), scene().settings());
    assert_eq!((settings.max_iterations, run.tolerance(), default.max_iterations), (7, 1e-3, 2000));
    let (single, rey) = (Precision::F32, Method::Rey2017);
    let of_defaults = Scene { precision: single, method: rey, ..Scene::default() };
    assert_eq!((of_defaults.tolerance(), of_defaults.settings().max_iterations), (1e-4, 20_000));
}

#[test]
fn an_account_has_the_keys_of_a_report() {
    let asked = Request {
        other_branch: true,
        stability: true,
        leave: true,
        after: After { stiffness: true, percolation: true, ..After::default() },
        ..Request::under(Control::MeanPressure(0.01))
    };
    let mut solved = solved(&asked);
    let report = json!(solved.account);
    let inputs = [Inputs::NUMBERS, Slopes::NUMBERS, Elastic::NUMBERS, Adhesion::NUMBERS];
    let expected = names(&[&[Account::NUMBERS][..], &inputs].concat());
    assert_eq!(keys(&report).into_iter().collect::<HashSet<_>>(), expected.into_iter().collect());
    assert_eq!(keys(&report["other_branch"]), names(&[OtherBranch::NUMBERS]));
    assert_eq!(keys(&report["stability"]), names(&[Steadiness::NUMBERS]));
    assert_eq!((&report["shape"], &report["tolerance"]), (&json!([32, 32]), &json!(1e-6)));
    assert!(report["contact_stiffness"].is_f64() && report["departures"] == json!([]));

    // the keys that are found of the fields
    let open = ["corrected_contact_fraction", "perimeter", "patches", "min_pressure", "max_pressure"];
    assert!(open.iter().all(|key| report[key].is_null()));
    let statistics = solved.look().unwrap();
    assert_eq!(solved.account.corrected_contact_fraction, statistics.corrected_contact_fraction);
    assert!(open.iter().all(|key| !json!(solved.account)[key].is_null()));
}

#[test]
fn nested_grids_tell_their_errors_after_a_look_and_those_of_an_accuracy_at_once() {
    let under = Request::under(Control::MeanPressure(0.01));
    let mut nested = solved(&Request { nested: Some(true), ..under });
    assert!(nested.account.grid_error.is_none());
    nested.look().unwrap();
    let report = json!(nested.account);
    assert_eq!(keys(&report["levels"][0]), names(&[GridLevel::NUMBERS]));
    assert_eq!(keys(&report["grid_error"]), names(&[GridErrors::NUMBERS]));

    let goal = Goal { accuracy: 0.05, of: Quantity::Area, memory: None };
    let Solved { found, account, .. } = solved(&Request { goal: Some(goal), ..under });
    let report = json!(account);
    assert_eq!(keys(&report["accuracy"]), names(&[Refinement::NUMBERS]));
    assert_eq!(keys(&report["grid_error"]["area"]), ["relative", "order", "rough"]);
    let shape = found.refined.unwrap().grid().shape();
    assert_eq!(report["shape"], json!([shape.0, shape.1]));
}

#[test]
fn a_contact_fraction_is_searched_for_and_an_observer_ends_a_solve() {
    let asked = Request { fraction: Some(0.2), ..Request::under(Control::MeanPressure(0.0)) };
    let Solved { account, .. } = solved(&asked);
    assert_eq!(keys(&json!(account)["search"]), names(&[Search::NUMBERS]));

    let asked = Request { stability: true, after: stiff(), ..Request::under(Control::MeanPressure(0.01)) };
    let solved = posed().solve(&asked, None, &mut |_, _, _| ControlFlow::Break(())).unwrap();
    let report = json!(solved.account);
    assert_eq!(report["status"], "stopped");
    assert!(report["stability"].is_null() && report["contact_stiffness"].is_null());
}

/// The rows of a way with the findings of each state, each row found by a session that continues the file of the
/// one before, as cells and depths.
fn continued(scene: &Scene, way: &Way, after: After) -> Vec<(Value, Option<Array2<f64>>)> {
    let folder = tempfile::tempdir().unwrap();
    let mut rows = Vec::new();
    loop {
        let file = TableFile { out: folder.path().join("table.jsonl"), ..TableFile::default() };
        let mut table = posed_by(scene).begin(way.clone(), after, false, None, Some(file)).unwrap();
        assert_eq!(table.count(), rows.len());
        let Some((found, row)) = next(&mut table) else { return rows };
        rows.push((row.cells(&table.columns()).into(), found.solution.plastic_depth));
        assert_eq!(table.read().unwrap().last(), rows.last().map(|(row, _)| row));
    }
}

/// The same by one session without a file.
fn at_once(scene: &Scene, way: &Way, after: After) -> Vec<(Value, Option<Array2<f64>>)> {
    let mut rows = posed_by(scene).begin(way.clone(), after, false, None, None).unwrap();
    let names = rows.columns();
    let cells = |(found, row): (Answer<f64>, Row)| {
        assert!(names.iter().all(|name| json!(row).as_object().unwrap().contains_key(*name)));
        (row.cells(&names).into(), found.solution.plastic_depth)
    };
    std::iter::from_fn(|| next(&mut rows)).map(cells).collect()
}

#[test]
fn a_course_goes_on_from_its_place_with_the_same_rows() {
    let free = Scene { elastic: Elastic { boundary: Boundary::Free, ..Elastic::default() }, ..scene() };
    let gaps = [0.02, 0.01, 0.04].map(Control::MeanGap).to_vec();
    let approaches = [0.0, 0.01, -0.02].map(Control::Approach).to_vec();
    for (scene, loads) in [(scene(), gaps), (free, approaches)] {
        let settings = PathSettings::default().steps(3);
        for way in [Way::Sweep(loads.clone()), Way::Search(vec![0.1, 0.2, 0.15]), Way::Cycle(loads, settings)] {
            let whole = at_once(&scene, &way, stiff());
            assert!(whole.len() >= 3);
            assert_eq!(continued(&scene, &way, stiff()), whole, "{way:?}");
        }
    }
}

#[test]
fn a_course_of_a_surface_that_yields_goes_on_with_its_depth() {
    let scene = Scene { adhesion: Adhesion { hardness: Some(0.08), ..Adhesion::default() }, ..Scene::default() };
    let loads = [0.01, 0.05, 0.01, 0.05].map(Control::MeanPressure).to_vec();
    let settings = PathSettings::default().steps(3);
    for way in [Way::Sweep(loads.clone()), Way::Search(vec![0.1, 0.3, 0.1]), Way::Cycle(loads, settings)] {
        let whole = at_once(&scene, &way, After::default());
        let rows = posed_by(&scene).begin(way.clone(), After::default(), false, None, None).unwrap();
        assert!(rows.columns().ends_with(&["plastic_depth_max", "plastic_depth_mean", "plastic_energy"]));
        assert!(whole.len() >= 3 && whole.iter().any(|(_, depth)| depth.as_ref().unwrap().sum() > 0.0), "{way:?}");
        assert_eq!(continued(&scene, &way, After::default()), whole, "{way:?}");
    }
}

#[test]
fn a_state_that_was_stopped_is_found_again_and_has_no_row() {
    let folder = tempfile::tempdir().unwrap();
    let file = || Some(TableFile { out: folder.path().join("table.csv"), ..TableFile::default() });
    let way = Way::Sweep([0.02, 0.01].map(Control::MeanGap).to_vec());
    let whole = at_once(&scene(), &way, After::default());
    let mut rows = posed().begin(way.clone(), After::default(), false, None, file()).unwrap();
    let sought = rows.seek(&mut |_| ControlFlow::Break(())).unwrap().unwrap();
    let (stopped, _) = rows.keep(sought).unwrap();
    assert_eq!((stopped.solution.report.status, rows.count()), (Status::Stopped, 0));
    for (row, _) in &whole {
        assert_eq!(&json!(next(&mut rows).unwrap().1.cells(&rows.columns())), row);
    }
    assert!(next(&mut rows).is_none());
    // another run may continue the file once it is released
    assert!(posed().begin(way.clone(), After::default(), false, None, file()).is_err());
    rows.release();
    posed().begin(way.clone(), After::default(), false, None, file()).unwrap();
    // without a place to come back to the way ends
    let mut rows = posed().begin(way, After::default(), false, None, None).unwrap();
    assert!(rows.next(&mut |_| ControlFlow::Break(())).unwrap().is_some());
    assert!(next(&mut rows).is_none() && !rows.columns().is_empty());
}

#[test]
fn a_way_that_the_problem_does_not_have_is_refused_with_a_file_and_without_one() {
    let folder = tempfile::tempdir().unwrap();
    let file = TableFile { out: folder.path().join("table.csv"), ..TableFile::default() };
    let refused = |way, file| posed().begin(way, After::default(), false, None, file).err().unwrap().to_string();
    let cycle = Way::Cycle([0.02, -0.01].map(Control::MeanGap).to_vec(), PathSettings::default());
    let told = refused(cycle.clone(), None);
    assert_eq!(refused(cycle, Some(file)), told);
    assert!(told.contains("-0.01"), "{told}");
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
    let infinite = refused(Way::Sweep(vec![Control::MeanPressure(f64::INFINITY)]), None);
    assert!(infinite.contains("load") && infinite.contains("finite"), "{infinite}");
}

#[test]
fn warnings_of_the_input_stand_in_accounts_and_rows_and_may_be_errors() {
    let grid = Grid::square(16, 1.0).unwrap();
    let tilted = || Surface::new(grid, Array2::from_shape_fn((16, 16), |(i, _)| 0.1 * i as f64)).unwrap();
    let scene = Scene::default();
    let mut session = session(&scene, tilted(), false).unwrap();
    let of_input: Vec<_> = session.facts.warnings.tell().iter().map(|told| told.code.clone()).collect();
    assert!(!of_input.is_empty());
    let load = Control::MeanPressure(0.01);
    let mut rows = session.begin(Way::Sweep(vec![load]), After::default(), false, None, None).unwrap();
    let (_, row) = next(&mut rows).unwrap();
    let codes: Vec<_> = row.account.warnings.iter().map(|told| told.code.clone()).collect();
    assert!(codes.starts_with(&of_input), "{codes:?}");
    // each is told once
    let new: Vec<_> = rows.warnings().tell().iter().map(|told| told.code.clone()).collect();
    assert_eq!([of_input.clone(), new].concat(), codes);
    let refused = self::session(&scene, tilted(), true).err().unwrap().to_string();
    assert!(refused.starts_with(&of_input[0]), "{refused}");
}

#[test]
fn a_scene_with_a_hardness_is_data_and_one_without_still_reads() {
    let adhesion = Adhesion { hardness: Some(0.25), ..Adhesion::default() };
    let run = Scene { adhesion, tolerance: Some(1e-6), max_iterations: Some(2000), ..Scene::default() };
    assert_eq!(serde_json::from_value::<Scene>(json!(run.inputs((4, 4), (1.0, 1.0), 1))).unwrap(), run);
    let old = json!({ "modulus": 1.0, "law": "none", "wall": "hard", "wall_stiffness": null });
    assert_eq!(serde_json::from_value::<Scene>(old).unwrap(), Scene::default());
}

#[test]
fn fields_that_are_not_finite_are_refused() {
    let Solved { mut found, .. } = solved(&Request::under(Control::MeanPressure(0.01)));
    check_finite(&found.solution).unwrap();
    found.solution.pressure[(3, 4)] = f64::NAN;
    let told = check_finite(&found.solution).unwrap_err();
    let told = worded(&told, Skin::Keywords);
    assert!(told.starts_with("the solve ran away") && told.contains("the pressure is not finite at 1 of 1024 nodes"));
    assert!(told.ends_with("use another start, or units in which the numbers are moderate"), "{told}");
}

#[test]
fn shortfalls_say_which_error_is_too_large_and_have_remedies_in_the_words_of_a_skin() {
    let Solved { account, .. } = solved(&Request::under(Control::MeanPressure(0.01)));
    assert!(shortfalls(&account, Skin::Options).is_empty());
    let iterations = account.iterations;
    for (status, relative_error, load_error, errors, remedy) in [
        (Status::Stalled, 1.2e-14, 1.0, "load error 1.0e0", "try another {initial_gap}, or hold a {mean_gap}"),
        (Status::Stalled, 1e-3, 1.0, "error 1.0e-3 and load error 1.0e0", "raise {tolerance}, or give another"),
        (Status::Stalled, 1e-3, 0.0, "error 1.0e-3", "raise {tolerance}, or give another {initial_gap}"),
        (Status::IterationLimit, 1e-3, 0.0, "error 1.0e-3", "raise {max_iterations}, or give a gap"),
        (Status::Detached, 1e-9, 0.0, "error 1.0e-9", "follow the branch by {cycle:mean_gaps}"),
    ] {
        let account = Account { status, relative_error, load_error, ..account.clone() };
        for skin in [Skin::Options, Skin::Keywords] {
            let told = shortfalls(&account, skin);
            let begin = format!("not converged ({status}): {errors} after {iterations} iterations, tolerance 1e-6; ");
            assert!(told.len() == 1 && told[0].0 == "convergence" && told[0].1.starts_with(&begin), "{told:?}");
            assert!(told[0].1.contains(&worded(remedy, skin)), "{told:?}");
        }
    }
    let text = "raise {tolerance}, give {initial_gap}, use {precision=f64} or {whole=}, or {cycle:mean_gaps}";
    let options =
        "raise --tolerance, give --initial-gap, use --precision f64 or --whole, or asperity cycle --mean-gaps";
    assert_eq!(worded(text, Skin::Options), options);
    let keywords = "raise tolerance, give start, use precision='f64' or whole=True, or asperity.cycle(mean_gaps=...)";
    assert_eq!(worded(text, Skin::Keywords), keywords);
}

#[test]
fn the_rows_of_solves_have_units_where_they_are_known_and_are_left_out_where_they_say_nothing() {
    let Solved { account, .. } = solved(&Request::under(Control::MeanPressure(0.01)));
    let summary = |solves: &[&Account], unit| rows(solves, &Units::of_map(unit), Skin::Options);
    let text = |rows: &[(String, Vec<String>)], name: &str| {
        rows.iter().find(|(row, _)| row == name).map(|(_, texts)| texts.join(", "))
    };
    let (bare, metres) = (summary(&[&account], None), summary(&[&account], Some("m")));
    assert_eq!(
        (text(&bare, "mean pressure"), text(&bare, "side lengths")),
        (Some("0.01".into()), Some("1 x 1".into()))
    );
    assert_eq!(text(&metres, "side lengths"), Some("1 m x 1 m".to_owned()));
    assert!(text(&metres, "mean gap").unwrap().ends_with(" mm") && text(&metres, "branch").is_some());
    assert_eq!((text(&bare, "wanted"), text(&bare, "stability"), text(&bare, "approach")), (None, None, None));
    let Solved { account: searched, .. } =
        solved(&Request { fraction: Some(0.2), ..Request::under(Control::MeanPressure(0.0)) });
    let both = summary(&[&account, &searched], None);
    assert!(text(&both, "wanted").unwrap().starts_with(", 20.0 %, after "), "{both:?}");
}

#[test]
fn theories_have_numbers_that_are_known() {
    let rough =
        SelfAffine::default().k_l(2.0).k_r(2.0).k_s(16.0).seed(1).surface(Grid::square(64, 1.0).unwrap()).unwrap();
    let elastic = Elastic { modulus: 2.0, ..Elastic::default() };
    let theories = Theories::new(&rough, &Scene { elastic, ..Scene::default() }).unwrap();
    // at three loads
    let expected = [
        (1e-3, 0.00797871263, 0.00747258970, 0.00994659216),
        (1e-2, 0.07965567455, 0.00411622230, 0.07885719492),
        (1e-1, 0.68268949214, 0.00021609249, 0.47855570016),
    ];
    let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
    let areas = theories.curves(("mean_pressure", "contact_fraction"), 1e-3, 0.1);
    let forces = theories.curves(("normal_force", "contact_fraction"), 1e-3, 0.1);
    let gaps = theories.curves(("mean_gap", "mean_pressure"), 1e-3, 0.1);
    for ((pressure, area, gap, light), k) in expected.into_iter().zip([0, 50, 100]) {
        near(areas[0].1[k].0, pressure);
        near(areas[0].1[k].1, area);
        near(gaps[0].1[k].0, gap);
        near(areas[1].1[k].1, light);
    }
    // on an area of one
    assert_eq!(areas[0].1, forces[0].1);
    assert!(theories.curves(("approach", "normal_force"), 1e-3, 0.1).is_empty());
}
