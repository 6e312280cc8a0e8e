//! Single precision at its floor.

use super::*;

/// The certified error of a gap as it is, in `f64`.
fn certified(scene: &Scene, gap: Array2<f64>) -> f64 {
    let settings = Settings::default().max_iterations(0).tolerance(1e-30);
    let control = Control::MeanGap(gap.mean().unwrap());
    let scene = Scene { settings, control, start: Some(gap), ..scene.clone() };
    scene.solution::<f64>().unwrap().report.relative_error
}

/// Light loads leave a displacement that is the small difference of heights and gap. The error of a gap in `f32`,
/// computed in `f64`, is no larger than certified where the solve has converged, and where it has stalled hardly larger
/// than the error of the exact gap rounded to `f32`.
#[test]
fn f32_is_as_good_as_it_says_and_is_given_up_at_its_floor() {
    let features = Features { precisions: &[Precision::Single], ..Features::HARD };
    let (mut wrong, mut solved) = (Vec::new(), [0; 2]);
    for seed in 0..400 {
        let mut scene = Scene::with_features(seed, &features);
        scene.settings.tolerance = Some(1e-5);
        let springs = matches!(scene.control, Control::Spring { .. });
        let tension = matches!(scene.control, Control::MeanPressure(p) | Control::Force(p) if p < 0.0);
        if scene.relief == "flat" || springs || tension {
            continue;
        }
        let Ok(Solution { gap, report, .. }) = scene.solution::<f32>() else { continue };
        let reached = certified(&scene, gap.mapv(f64::from));
        let said = report.relative_error;
        if report.status == Status::Converged && reached > 3.0 * (said + f64::from(f32::EPSILON)) {
            wrong.push(format!("{reached:.1e}, not {said:.1e}, in {scene}"));
        }
        solved[usize::from(report.status == Status::Stalled)] += 1;
        // heights of few levels round alike, or not at all
        let levels = matches!(scene.relief, "step" | "board" | "levels");
        if report.status == Status::Stalled && said.is_finite() && !levels {
            scene.settings.tolerance = Some(1e-12);
            scene.start = None;
            let exact = scene.solution::<f64>().unwrap();
            let floor = certified(&scene, exact.gap.mapv(|g| f64::from(g as f32)));
            // the exact gap of a few nodes may happen to round to hardly any error
            let usual =
                f64::from(f32::EPSILON) * (rounded_work(&scene, report.mean_gap) / report.elastic_energy).sqrt();
            if reached > 40.0 * floor.max(usual).max(f64::from(f32::EPSILON)) {
                wrong.push(format!("{reached:.1e}, and {floor:.1e} is possible, in {scene}"));
            }
        }
    }
    let [converged, stalled] = solved;
    wrong.iter().for_each(|wrong| println!("{wrong}"));
    assert!(
        wrong.is_empty() && converged > 2 * stalled,
        "{} wrong, {converged} converged, {stalled} stalled",
        wrong.len()
    );
}

/// The work ⟨u, p⟩ to which rounding adds a share ε².
fn rounded_work(scene: &Scene, mean_gap: f64) -> f64 {
    let (surface, dense) = (scene.centred(), scene.dense());
    let rms = surface.iter().map(|h| h * h).sum::<f64>().sqrt() / (surface.len() as f64).sqrt();
    dense.work(&surface) + dense.stiffest * mean_gap * (mean_gap + rms)
}
