//! Spheres among their periodic images.

use super::*;

/// ζ(s) and β(s) by the alternating series, accelerated (Cohen, Rodriguez Villegas and Zagier, 2000).
fn zeta_beta(s: f64) -> (f64, f64) {
    let alternating = |term: &dyn Fn(f64) -> f64| {
        let n = 24;
        let d = (3.0 + 8f64.sqrt()).powi(n);
        let d = 0.5 * (d + 1.0 / d);
        let (mut b, mut c, mut sum) = (-1.0, -d, 0.0);
        for k in 0..n {
            let (k, n) = (f64::from(k), f64::from(n));
            c = b - c;
            sum += c * term(k);
            b *= (k + n) * (k - n) / ((k + 0.5) * (k + 1.0));
        }
        sum / d
    };
    let eta = alternating(&|k| (k + 1.0).powf(-s));
    (eta / (1.0 - 2f64.powf(1.0 - s)), alternating(&|k| (2.0 * k + 1.0).powf(-s)))
}

#[test]
fn lattice_constants() {
    // (their sums over the lattice are in the module's own tests)
    let ((zeta_1, beta_1), (zeta_3, beta_3)) = (zeta_beta(0.5), zeta_beta(1.5));
    assert_relative_eq!(M1, -4.0 * zeta_1 * beta_1, max_relative = 4e-15);
    assert_relative_eq!(C2, zeta_3 * beta_3, max_relative = 4e-15);
    assert_relative_eq!(zeta_3, 2.612_375_348_685_488, max_relative = 1e-15);
}

#[test]
fn the_papers_states_among_images() {
    for (w, range, gap) in PAPER {
        let sphere = MaugisDugdale::new(2.0, 1.0, w, range).unwrap();
        let periodic = Periodic::new(sphere, 1.0).unwrap();
        let state = periodic.at_mean_gap(gap, -1.0 / 24.0).unwrap();
        let contact = state.contact();
        // Maugis' sphere of the radius that the images leave, at the mean gap that their shift leaves
        let bent = (0.5 + 2.0 * C2 * state.mean_pressure() / PI).recip();
        let [a, c, load, approach] = maugis(contact.adhesion_radius() / contact.contact_radius(), bent, w, range);
        assert_relative_eq!(contact.contact_radius(), a, max_relative = 1e-8);
        assert_relative_eq!(contact.adhesion_radius(), c, max_relative = 1e-8);
        assert_relative_eq!(state.mean_pressure(), load, max_relative = 1e-8, epsilon = 1e-8 * w);
        let moment = pieces(|r| TAU * r.powi(3) * contact.pressure(r), &[0.0, a, c]);
        let level = 1.0 / 24.0 - approach + M1 * load / PI - C2 / PI * moment;
        assert!((level - gap).abs() < 1e-9, "{level} {gap}");
        assert_relative_eq!(state.mean_gap(-1.0 / 24.0), gap, max_relative = 1e-14);
        assert!(periodic.pull_off().unwrap().mean_pressure() <= state.mean_pressure());
        let by_radius = periodic.at_contact_radius(state.contact().contact_radius()).unwrap();
        assert_relative_eq!(by_radius.mean_gap(-1.0 / 24.0), gap, max_relative = 1e-13);
    }
}

fn checks_images(sphere: impl Sphere, gap: f64, quartic: f64, lattice: f64) {
    let grid = Grid::square(256, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let state = Periodic::new(sphere, 1.0).unwrap().at_mean_gap(gap, surface.mean()).unwrap();
    let (contact, u) = (state.contact(), state.displacement_field(&grid).unwrap());
    // what the images' next term leaves: a share of |P| a⁴/(πE*L⁵)
    let allowed = quartic * contact.adhesion_radius().powi(4) + 1e-15;
    let mut worst = 0.0f64;
    for ((i, j), &u) in u.indexed_iter() {
        let (x, y) = (grid.x(i), grid.y(j));
        if x.hypot(y) <= contact.contact_radius() {
            worst = worst.max((u - surface.heights()[[i, j]]).abs());
        }
    }
    assert!(worst < allowed, "{worst:e} {allowed:e}");
    // u has zero mean but for its datum, which was never imposed: the given mean gap, to the same order and to the
    // error of a sum over nodes for a function that is not smooth at the edge of the contact
    let mean = u.mean().unwrap() - surface.mean();
    assert!((mean - gap).abs() < allowed + lattice, "{mean} {gap}");
}

#[test]
fn the_images_flatten_the_surface_and_keep_the_mean_gap() {
    for gap in [0.041, 0.0398, 0.0390] {
        let state = Periodic::new(Hertz::new(2.0, 1.0).unwrap(), 1.0).unwrap().at_mean_gap(gap, -1.0 / 24.0).unwrap();
        checks_images(Hertz::new(2.0, 1.0).unwrap(), gap, 5.0 * state.mean_pressure(), 3e-10);
    }
    checks_images(Jkr::new(2.0, 1.0, 1e-5).unwrap(), 0.0405, 1e-4, 3e-8);
    for (w, range, gap) in PAPER {
        checks_images(MaugisDugdale::new(2.0, 1.0, w, range).unwrap(), gap, 5.0 * 10.0 * w, 2e-8);
    }
    // images far away: a sphere alone
    let hertz = Hertz::new(2.0, 1.0).unwrap();
    let (alone, among) = (hertz.at_load(1e-4).unwrap(), Periodic::new(hertz, 1e4).unwrap().at_load(1e-4).unwrap());
    assert_relative_eq!(alone.contact_radius(), among.contact().contact_radius(), max_relative = 1e-13);
    assert_relative_eq!(among.mean_pressure(), 1e-12, max_relative = 1e-15);
}

#[test]
fn periodic_states_lead_back() {
    let jkr = Jkr::new(2.0, 1.0, 1e-5).unwrap();
    let periodic = Periodic::new(jkr, 1.0).unwrap();
    for a in [0.03, 0.05, 0.1, 0.2, 0.3, 0.33] {
        let state = periodic.at_contact_radius(a).unwrap();
        assert_relative_eq!(state.contact().contact_radius(), a, max_relative = 1e-15);
        let (load, gap) = (state.contact().load(), state.mean_gap(0.0));
        let same = periodic.at_mean_gap(gap, 0.0).unwrap();
        assert_relative_eq!(same.contact().contact_radius(), a, max_relative = 1e-11);
        if a > 0.06 {
            assert_relative_eq!(periodic.at_load(load).unwrap().contact().contact_radius(), a, max_relative = 1e-12);
        }
    }
    // the maximum of the gap, at which contact is lost, is past the minimum of the load
    let pull_off = periodic.pull_off().unwrap();
    assert!(pull_off.mean_gap(0.0) < periodic.at_contact_radius(0.03).unwrap().mean_gap(0.0));
}

#[test]
fn a_solve_with_maugis_law_tends_to_the_exact_state_among_images() {
    let (w, range, gap) = PAPER[1];
    let errors = [128, 256, 512].map(|n| {
        let grid = Grid::square(n, 1.0).unwrap();
        let surface = Surface::paraboloid(grid, 2.0).unwrap();
        let sphere = MaugisDugdale::new(2.0, 1.0, w, range).unwrap();
        let exact = Periodic::new(sphere, 1.0).unwrap().at_mean_gap(gap, surface.mean()).unwrap();
        let u = exact.displacement_field(&grid).unwrap();
        let start = (&u - surface.heights()).mapv(|g| g.max(0.0));
        let law = asperity::MaugisDugdale::new(w, range).unwrap();
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        let mut solver = Solver::new(Settings::default().tolerance(1e-8));
        let found = solver
            .solve_with(&mut problem, Control::MeanGap(gap), Start::From(&start), |_| ControlFlow::Continue(()))
            .unwrap();
        assert_eq!(found.report.status, Status::Converged);
        // the traction is 0.05 on whole nodes: its zone's area, and with it the pressure, by some share of its edge
        // nodes
        let edge = 0.05 * TAU * exact.contact().adhesion_radius() / n as f64;
        assert!((found.report.mean_pressure - exact.mean_pressure()).abs() < 0.1 * edge);
        let difference = &found.gap + surface.heights() - &u;
        (difference.mapv(|d| d * d).sum() / u.mapv(|u| u * u).sum()).sqrt()
    });
    // at least of first order
    assert!(errors[2] < 2e-3 && errors[2] < 0.5 * errors[1] && errors[1] < 0.6 * errors[0], "{errors:?}");
}
