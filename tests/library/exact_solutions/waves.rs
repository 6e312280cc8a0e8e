//! Waves that touch, without adhesion and with it.

use super::*;

/// The mean of a wave's field times cos(2πkx/λ), the field even about x = 0 and not smooth at ±`edge`.
fn harmonic(field: impl Fn(f64) -> f64, k: u8, edge: f64, wavelength: f64) -> f64 {
    let q = TAU * f64::from(k) / wavelength;
    2.0 / wavelength * pieces(|x| field(x) * (q * x).cos(), &[0.0, edge, 0.5 * wavelength])
}

fn checks_wave(state: &WaveContact, wavelength: f64, modulus: f64, closing: f64, amplitude: f64) {
    let a = state.half_width();
    let p = |k| harmonic(|x| state.pressure(x), k, a, wavelength);
    let u = |k| harmonic(|x| state.displacement(x), k, a, wavelength);
    assert!((p(0) - state.mean_pressure()).abs() < 2e-7 * closing, "{} {state:?}", p(0));
    // the height has zero mean
    assert!((u(0) - state.mean_gap()).abs() < 1e-10 * amplitude, "{} {state:?}", u(0));
    for k in 1..=6 {
        let stiffness = PI * modulus * f64::from(k) / wavelength;
        assert!((p(k) - stiffness * u(k)).abs() < 2e-7 * closing, "{k} {state:?}");
    }
}

#[test]
fn westergaards_wave() {
    let (amplitude, wavelength, modulus) = (0.03, 2.5, 7.0);
    let wave = WavyLine::new(amplitude, wavelength, modulus).unwrap();
    let closing = wave.closing_pressure();
    assert_relative_eq!(closing, PI * modulus * amplitude / wavelength, max_relative = 1e-15);
    for s in [1e-12, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.0 - 1e-12, 1.0] {
        let state = wave.at_mean_pressure(s * closing).unwrap();
        checks_wave(&state, wavelength, modulus, closing, amplitude);
        let s_here = (PI * state.half_width() / wavelength).sin().powi(2);
        assert_relative_eq!(s_here, s, max_relative = 1e-12);
        assert_relative_eq!(state.mean_gap(), amplitude * (1.0 - s + s * s.ln()), epsilon = 1e-15);
        let same = wave.at_mean_gap(state.mean_gap()).unwrap();
        assert_relative_eq!(same.mean_gap(), state.mean_gap(), max_relative = 1e-13);
        assert_relative_eq!(same.mean_pressure(), state.mean_pressure(), max_relative = 1e-2);
        let same = wave.at_half_width(state.half_width()).unwrap();
        assert_relative_eq!(same.mean_pressure(), state.mean_pressure(), max_relative = 1e-12);
    }
    let full = wave.at_mean_pressure(1.5 * closing).unwrap();
    assert_eq!((full.half_width(), full.mean_gap()), (0.5 * wavelength, 0.0));
    assert_relative_eq!(full.pressure(0.5 * wavelength), 0.5 * closing, max_relative = 1e-14);
    assert_eq!(wave.at_mean_gap(amplitude).unwrap().mean_pressure(), 0.0);
    assert_relative_eq!(closing_pressure_2d(amplitude, wavelength, modulus).unwrap(), SQRT_2 * closing);
}

#[test]
fn johnsons_wave() {
    let (amplitude, wavelength, modulus) = (0.03, 2.5, 7.0);
    for alpha in [0.01, 0.2, 0.5, 0.9, 1.06] {
        let w = 0.5 * (alpha * PI * amplitude).powi(2) * modulus / wavelength;
        let wave = AdhesiveWavyLine::new(amplitude, wavelength, modulus, w).unwrap();
        assert_relative_eq!(wave.alpha(), alpha, max_relative = 1e-14);
        let closing = wave.closing_pressure();
        let (low, high) = (wave.pull_off().unwrap(), wave.jump_to_full_contact().unwrap());
        for share in [0.02, 0.2, 0.4] {
            let state = wave.at_half_width(share * wavelength).unwrap();
            checks_wave(&state, wavelength, modulus, closing, amplitude);
            // the energy release rate K²/2E* at the edge is w: from the pressure, K = lim −p √(2πd)
            let d = 1e-7 * wavelength;
            let k = -state.pressure(share * wavelength - d) * (TAU * d).sqrt();
            assert_relative_eq!(k * k / (2.0 * modulus), w, max_relative = 1e-3 / alpha);
        }
        // extremes by a scan of the half-width
        let (a, b) = (low.half_width(), high.half_width());
        for i in 0..=100 {
            let x = a + (b - a) * f64::from(i) / 100.0;
            let p = wave.at_half_width(x).unwrap().mean_pressure();
            assert!(low.mean_pressure() <= p + 1e-14 * closing && p <= high.mean_pressure() + 1e-14 * closing);
        }
        for x in [0.9 * a, 0.99 * a] {
            assert!(wave.at_half_width(x).unwrap().mean_pressure() > low.mean_pressure());
        }
        let middle = wave.at_half_width(0.5 * (a + b)).unwrap();
        let by_pressure = wave.at_mean_pressure(middle.mean_pressure()).unwrap();
        // near the merging of the extremes the slope of the pressure vanishes
        assert_relative_eq!(by_pressure.half_width(), middle.half_width(), max_relative = 1e-9);
        let by_gap = wave.at_mean_gap(middle.mean_gap()).unwrap();
        assert_relative_eq!(by_gap.half_width(), middle.half_width(), max_relative = 1e-11);
    }
    // without adhesion Westergaard's
    let (wave, bare) = (AdhesiveWavyLine::new(0.02, 1.0, 1.0, 1e-30).unwrap(), WavyLine::new(0.02, 1.0, 1.0).unwrap());
    let (state, limit) = (wave.at_mean_gap(0.005).unwrap(), bare.at_mean_gap(0.005).unwrap());
    assert_relative_eq!(state.mean_pressure(), limit.mean_pressure(), max_relative = 1e-10);
}

#[test]
fn johnsons_parameter_gives_the_known_pull_off() {
    // −0.0556 p* for α = 0.2 (Johnson, 1995); no load at all gives full contact from α = 0.57 on
    let wave = |alpha: f64| AdhesiveWavyLine::new(1.0 / PI, 1.0, 1.0, 0.5 * alpha * alpha).unwrap();
    let pull_off = wave(0.2).pull_off().unwrap().mean_pressure();
    assert!((pull_off + 0.0556).abs() < 0.5e-4, "{pull_off}");
    let jump = |alpha: f64| wave(alpha).jump_to_full_contact().unwrap().mean_pressure();
    assert!(jump(0.569) > 0.0 && jump(0.570) < 0.0);
    assert!(wave(1.0651).pull_off().is_ok() && wave(1.0653).pull_off().is_err());
}
