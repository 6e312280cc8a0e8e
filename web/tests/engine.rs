//! The engine of the page as its keys drive it, compared with the library and with the lines that it gives.

use asperity_web::Engine;
use serde_json::{Value, json};

/// Solves without an observer.
fn solve(engine: &mut Engine, scene: Value, from_last: bool) -> Value {
    engine.solve(&scene.to_string(), from_last, &mut |_, _, _| {}).unwrap()
}

/// The refusal of a solve.
fn refused(engine: &mut Engine, scene: Value) -> String {
    engine.solve(&scene.to_string(), false, &mut |_, _, _| {}).unwrap_err().to_string()
}

fn rough(parameters: Value) -> Engine {
    let mut all = json!({ "size": 64, "lengths": "1um", "rms_slope": 0.1, "k_s": 16, "seed": 3 });
    all.as_object_mut().unwrap().extend(parameters.as_object().unwrap().clone());
    let mut engine = Engine::default();
    engine.make(&all.to_string()).unwrap();
    engine
}

#[test]
fn a_drag_comes_to_the_equilibrium_of_a_solve_from_the_default() {
    let scenes = [
        json!({}),
        json!({ "precision": "f32" }),
        json!({ "hardness": "30MPa" }),
        json!({ "boundary": "free" }),
        json!({ "layer": "100nm", "poisson": 0.3 }),
    ];
    for given in scenes {
        let mut engine = rough(json!({}));
        let scene = |pressure: &str| {
            let mut scene = json!({ "modulus": "1GPa", "mean_pressure": pressure });
            scene.as_object_mut().unwrap().extend(given.as_object().unwrap().clone());
            scene
        };
        solve(&mut engine, scene("2MPa"), true);
        // up and down again: a surface that yields is pressed for the first time with every solve
        solve(&mut engine, scene("8MPa"), true);
        let dragged = solve(&mut engine, scene("3MPa"), true);
        let fresh = solve(&mut engine, scene("3MPa"), false);
        assert_eq!((&dragged["started"], &fresh["started"]), (&json!("last"), &json!("default")));
        let of = |answer: &Value, key: &str| answer["account"][key].as_f64().unwrap();
        for answer in [&dragged, &fresh] {
            assert_eq!(answer["account"]["status"], "converged", "{given}");
        }
        // both are within the tolerance of one equilibrium: nodes at its edge touch or not
        let nodes = of(&fresh, "contact_nodes");
        assert!((of(&dragged, "contact_nodes") - nodes).abs() <= 0.01 * nodes, "{given}");
        let tolerance = 10.0 * of(&fresh, "tolerance");
        assert!((of(&dragged, "elastic_energy") / of(&fresh, "elastic_energy") - 1.0).abs() < tolerance, "{given}");
        if given.get("hardness").is_some() {
            assert!(of(&fresh, "plastic_fraction") > 0.0);
            assert!(engine.problem().unwrap().regions().unwrap().contains(&4));
        }
    }
}

#[test]
fn another_engine_continues_from_the_gap_of_an_adhesive_solution() {
    for precision in ["f32", "f64"] {
        let scene = |pressure: &str| {
            json!({
                "modulus": "1GPa", "mean_pressure": pressure, "precision": precision,
                "law": "exponential", "work_of_adhesion": "20mJ/m2", "range": "2nm",
            })
        };
        let (mut engine, mut twin) = (rough(json!({})), rough(json!({})));
        assert!(engine.gap().unwrap_err().to_string().contains("solve first"));
        assert!(twin.start_from(vec![0.0; 3]).is_err());
        solve(&mut engine, scene("2MPa"), true);
        twin.start_from(engine.gap().unwrap()).unwrap();
        let [mine, other] = [&mut engine, &mut twin].map(|engine| solve(engine, scene("8MPa"), true));
        for key in ["iterations", "contact_nodes", "mean_gap"] {
            assert_eq!(mine["account"][key], other["account"][key], "{key} in {precision}");
        }
        assert_eq!(other["started"], "last");
    }
}

#[test]
fn another_scene_goes_on_from_the_last_solution_on_the_same_surface() {
    let mut engine = rough(json!({}));
    let scene = json!({ "modulus": "1GPa", "mean_pressure": "5MPa" });
    solve(&mut engine, scene.clone(), true);
    let sticky = json!({ "modulus": "1GPa", "mean_pressure": "5MPa", "law": "exponential",
        "work_of_adhesion": "10mJ/m2", "range": "3nm" });
    assert_eq!(solve(&mut engine, sticky.clone(), true)["started"], "last");
    let lines = engine.lines().unwrap();
    assert!(lines["shell"][1].as_str().unwrap().contains("--initial-gap start.npz"));
    assert!(engine.file("start.npz").unwrap().starts_with(b"PK"));
    // without adhesion there is one equilibrium, whatever the start
    solve(&mut engine, scene, true);
    assert!(!engine.lines().unwrap()["shell"][1].as_str().unwrap().contains("initial-gap"));
    assert!(engine.file("start.npz").is_err());
    // another surface has another gap
    engine.prepare(&json!({ "flip": true }).to_string()).unwrap();
    assert_eq!(solve(&mut engine, sticky, true)["started"], "default");
}

#[test]
fn the_lines_of_python_have_the_keys_of_the_program() {
    let mut engine = rough(json!({}));
    let scene = json!({ "modulus": "1GPa", "mean_pressure": "5MPa", "law": "lennard-jones", "work_of_adhesion": "10mJ/m2",
        "range": "3nm", "cut_off": "30nm", "layer": "100nm", "poisson": "0.3", "precision": "f32" });
    solve(&mut engine, scene, false);
    assert_eq!(
        engine.lines().unwrap()["python"],
        r#"import asperity

surface = asperity.surface.self_affine(64, "1um", rms_slope=0.1, k_s=16, seed=3)
solution = asperity.solve(surface, modulus="1GPa", mean_pressure="5MPa", law="lennard-jones", work_of_adhesion="10mJ/m2", range="3nm", cut_off="30nm", layer="100nm", poisson=0.3, precision="f32")
solution
"#
    );
}

#[test]
fn what_is_no_value_is_refused_and_the_last_solution_stays() {
    let mut engine = rough(json!({}));
    let good = json!({ "modulus": "1GPa", "mean_pressure": "5MPa" });
    solve(&mut engine, good.clone(), true);
    let message = refused(&mut engine, json!({ "modulus": "1GPa", "mean_pressure": { "value": 5 } }));
    assert!(message.starts_with("mean_pressure is {") && message.contains("a number"), "{message}");
    assert_eq!(solve(&mut engine, good, true)["started"], "last");
}

#[test]
fn a_measured_map_is_prepared_and_solved_on_its_original() {
    let mut text = String::new();
    for i in 0..24 {
        let heights = (0..16).map(|j| match (i, j) {
            (3, 4) => "nan".to_owned(),
            _ => format!("{:e}", 0.3 * f64::from(i) + (0.9 * f64::from(i)).sin() * (0.7 * f64::from(j)).cos()),
        });
        text += &(heights.collect::<Vec<_>>().join(" ") + "\n");
    }
    let mut engine = Engine::default();
    let map = engine.open("scan.txt", text.as_bytes(), None, false).unwrap();
    assert_eq!((&map["missing"], &map["lengths"]), (&json!(1), &Value::Null));
    let scene = json!({ "modulus": "1GPa", "mean_pressure": "50MPa" });
    assert!(refused(&mut engine, scene.clone()).contains("give lengths"));
    let steps =
        json!({ "unit": "nm", "lengths": ["240nm", "160nm"], "detrend": "plane", "fill": true, "mirror": true });
    let map = engine.prepare(&steps.to_string()).unwrap();
    assert_eq!((&map["shape"], &map["original"]), (&json!([48, 32]), &json!([24, 16])));
    let names: Vec<_> = map["log"].as_array().unwrap().iter().map(|line| line[0].as_str().unwrap()).collect();
    assert_eq!(names, ["read", "lengths", "unit", "detrend", "fill", "mirror"]);
    let answer = solve(&mut engine, scene, false);
    assert_eq!(answer["shape"], json!([24, 16]));
    let problem = engine.problem().unwrap();
    for field in ["gap", "pressure", "contact_pressure", "displacement"] {
        assert_eq!(problem.field(field).unwrap().len(), 24 * 16, "{field}");
    }
    let touching = problem.regions().unwrap().iter().filter(|node| **node == 1).count();
    assert_eq!(answer["account"]["contact_nodes"], touching);
    let lines = engine.lines().unwrap();
    let prepare = lines["shell"][0].as_str().unwrap();
    assert!(
        prepare.starts_with("asperity prepare scan.txt --unit nm --lengths 240nm 160nm --detrend plane"),
        "{prepare}"
    );
    // a step that is refused changes nothing
    assert!(engine.prepare(&json!({ "detrend": "plan" }).to_string()).is_err());
    assert_eq!(engine.surface().unwrap().heights.dim(), (48, 32));
}

#[test]
fn a_cycle_has_its_jumps_and_its_table() {
    let mut engine = Engine::default();
    let wave = json!({ "size": 32, "form": "wave", "periods": [1, 1], "amplitude": 0.02 });
    engine.make(&wave.to_string()).unwrap();
    let cycle = json!({ "mean_gaps": "0.03,0.0,0.03", "steps": 12, "law": "exponential", "work_of_adhesion": 4e-4,
        "range": 3e-3 });
    engine.begin(&cycle.to_string()).unwrap();
    let mut events = Vec::new();
    let mut count = 0;
    while let Some(state) = engine.next(&mut |_, _, _| {}).unwrap() {
        events.extend(state["row"]["event"].as_str().map(str::to_owned));
        count += 1;
    }
    assert!(count > 24 && events.iter().any(|event| event == "jump-in"), "{count} states, {events:?}");
    let table = String::from_utf8(engine.file("table.csv").unwrap()).unwrap();
    assert_eq!(table.lines().count(), count + 1);
    assert!(table.starts_with("leg,direction,control,control_value,"));
    // there is nothing beyond the end
    assert!(engine.next(&mut |_, _, _| {}).unwrap().is_none());
}

#[test]
fn a_cycle_without_a_range_has_its_limits() {
    let mut engine = Engine::default();
    engine.make(&json!({ "size": 32, "form": "wave", "periods": [1, 1], "amplitude": 0.02 }).to_string()).unwrap();
    let cycle = json!({ "mean_gaps": "0.03,0.015,0.05", "steps": 12, "law": "jkr", "work_of_adhesion": 4e-4 });
    engine.begin(&cycle.to_string()).unwrap();
    let mut tension = 0.0;
    while let Some(state) = engine.next(&mut |_, _, _| {}).unwrap() {
        tension = f64::max(tension, -state["row"]["mean_pressure"].as_f64().unwrap());
    }
    let limit = engine.cycle_limit(&mut |_, _, _| {}).unwrap().unwrap();
    let number = |name: &str| limit[name].as_f64().unwrap();
    assert!((number("tension_limit") - tension).abs() < 2.0 * number("tension_limit_error"), "{limit}, {tension}");
    assert!(number("work_limit") > 2.0 * number("work_limit_error"), "{limit}");
}
