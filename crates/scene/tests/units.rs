//! Quantities have the bits of their numbers in SI units, figures their units, and names that are none what they mean;
//! lists, legs of tables and the time that is left are read as people mean them.

use asperity::path::PathSettings;
use asperity_scene::allowed::Range;
use asperity_scene::fall::{Fall, time};
use asperity_scene::legs::{Leg, abscissa, legs, logarithmic};
use asperity_scene::list::{Loads, parsed};
use asperity_scene::pace::Pace;
use asperity_scene::synonyms::{SYNONYMS, is_same, meant, similar};
use asperity_scene::{
    AREA, CONDUCTIVITY, ENERGY, ENERGY_PER_AREA, FORCE, FORCE_PER_LENGTH, LENGTH, PER_LENGTH, PER_PRESSURE, PRESSURE,
    PRESSURE_PER_LENGTH, RESISTIVITY, THERMAL_CONDUCTANCE, TRANSMISSIVITY, Units, power_of_length, times_ten_to,
};
use serde_json::{Value, json};

#[test]
fn a_quantity_has_the_bits_of_the_number_in_si_units() {
    for (dimension, text, value) in [
        (LENGTH, "20um", 20e-6),
        (LENGTH, "2.7 nm", 2.7e-9),
        (LENGTH, "-0.3nm", -0.3e-9),
        (LENGTH, "3.3Å", 3.3e-10),
        (LENGTH, "1e3µm", 1e-3),
        (LENGTH, "7\u{3bc}m", 7e-6),
        (LENGTH, "5m", 5.0),
        (LENGTH, "5mm", 5e-3),
        (LENGTH, "1.25cm", 1.25e-2),
        (PER_LENGTH, "2/um", 2e6),
        (PER_LENGTH, "2 1/um", 2e6),
        (PER_LENGTH, "2um-1", 2e6),
        (PRESSURE, "70GPa", 70e9),
        (PRESSURE, "2.5MPa", 2.5e6),
        (PRESSURE, "1E5Pa", 1e5),
        (PRESSURE, "3mPa", 3e-3),
        (PRESSURE, "4 N/mm2", 4e6),
        (FORCE, "5nN", 5e-9),
        (FORCE, "2MPa µm^2", 2e-6),
        (FORCE_PER_LENGTH, "40N/m", 40.0),
        (ENERGY_PER_AREA, "50mJ/m2", 50e-3),
        (ENERGY_PER_AREA, "50mJ/m²", 50e-3),
        (ENERGY_PER_AREA, "72mN/m", 72e-3),
        (ENERGY, "60zJ", 60e-21),
        (ENERGY, "2eV", 2e-19 * 1.602176634),
        (PRESSURE_PER_LENGTH, "1GPa/um", 1e15),
        (RESISTIVITY, "17nOhm·m", 17e-9),
        (RESISTIVITY, "17 nΩm", 17e-9),
        (RESISTIVITY, "2.4uOhm*cm", 2.4e-8),
        (RESISTIVITY, "2.4µΩcm", 2.4e-8),
        (RESISTIVITY, "3V m/A", 3.0),
        (CONDUCTIVITY, "400W/mK", 400.0),
        (CONDUCTIVITY, "0.4 kW/(m·K)", 400.0),
        (CONDUCTIVITY, "4W/cm K", 400.0),
        (LENGTH, "5micron", 5e-6),
        (LENGTH, "2.5 microns", 2.5e-6),
        (PRESSURE, "0.2TPa", 0.2e12),
        (PRESSURE, "3bar", 3e5),
        (PRESSURE, "20mbar", 2e3),
        (PRESSURE, "1.5kbar", 1.5e8),
        (PRESSURE, "30psi", 30e3 * 6.894757293168361),
        (PRESSURE, "30ksi", 30e6 * 6.894757293168361),
        (ENERGY_PER_AREA, "50erg/cm²", 50e-3),
        (ENERGY_PER_AREA, "50 erg/cm2", 50e-3),
        (ENERGY_PER_AREA, "50 erg cm^-2", 50e-3),
        (ENERGY_PER_AREA, "72dyn/cm", 72e-3),
        (ENERGY_PER_AREA, "50 mJ m-2", 50e-3),
        (FORCE_PER_LENGTH, "40 N m-1", 40.0),
        (FORCE_PER_LENGTH, "40 N m\u{2212}1", 40.0),
        (FORCE_PER_LENGTH, "40 N·m⁻¹", 40.0),
        (PER_LENGTH, "2um-1", 2e6),
        (CONDUCTIVITY, "400 W m-1 K-1", 400.0),
        (CONDUCTIVITY, "4 W cm^-1 K^-1", 400.0),
        (LENGTH, "0.1", 0.1),
    ] {
        let found = dimension.within(Range::FINITE)(text).unwrap();
        assert_eq!((found.value, found.has_unit), (value, text != "0.1"), "{text}");
    }
    assert_eq!(
        ["nm", "m", "micron", "Pa", "px", ""].map(power_of_length),
        [Some(-9), Some(0), Some(-6), None, None, None]
    );
    assert_eq!((times_ten_to(-9, 2.7), times_ten_to(9, 4e-6)), (2.7e-9, 4000.0));
}

#[test]
fn units_of_other_dimensions_and_nonsense_are_refused() {
    let pressure = PRESSURE.within(Range::POSITIVE);
    for text in ["70", "70GPa"] {
        assert!(pressure(text).is_ok(), "{text}");
    }
    for text in
        ["70um", "70N", "GPa", "70gpa", "70 G", "-1GPa", "0Pa", "infPa", "1e400Pa", "1Pa/", "1/Pa", "1e99999999999Pa"]
    {
        let error = pressure(text).unwrap_err();
        assert!(error.contains("positive and finite") && error.contains("as 70GPa"), "{text}: {error}");
    }
    for (text, mistake) in [
        ("70gpa", "gpa is no unit that is known (did you mean GPa?), it must"),
        ("70MPA", "MPA is no unit that is known (did you mean MPa or mPa?), it must"),
        ("4n/MM2", "n/MM2 is no unit that is known (did you mean N/Mm2 or N/mm2?), it must"),
        ("70pA", "pA is a unit of something else (did you mean Pa?), it must"),
        ("70px", "px is no unit that is known, it must"),
        ("70GPa1", "GPa1 is no unit that is known, it must"),
        ("70um", "um is a unit of something else, it must"),
        ("-1GPa", "it must"),
        ("-0.1", "it must"),
        ("-25", "it must"),
    ] {
        let error = pressure(text).unwrap_err();
        assert!(error.starts_with(mistake), "{text}: {error}");
    }
    // a long text has no more spellings than are looked at
    assert!(pressure(&format!("1{}", "MM ".repeat(1000))).unwrap_err().starts_with("MM MM"));
    assert!(LENGTH.within(Range::NON_NEGATIVE)("0nm").is_ok() && LENGTH.within(Range::FINITE)("-6nm").is_ok());
    // zero says nothing of units
    assert!(
        !LENGTH.within(Range::FINITE)("0").unwrap().is_bare() && LENGTH.within(Range::FINITE)("1").unwrap().is_bare()
    );
}

fn units(length: &str, pressure: &str) -> Units {
    Units { length: Some(length.to_owned()), pressure: Some(pressure.to_owned()), force: None }
}

#[test]
fn units_of_a_dimension_follow_from_length_and_pressure() {
    let dimensions = [LENGTH, PRESSURE, FORCE, ENERGY_PER_AREA, PRESSURE_PER_LENGTH, PER_LENGTH, PER_PRESSURE];
    let names = |units: Units| dimensions.map(|dimension| units.unit(dimension).unwrap_or_default());
    assert_eq!(names(Units::si()), ["m", "Pa", "N", "J/m²", "Pa/m", "1/m", "1/Pa"]);
    assert_eq!(names(units("um", "MPa")), ["um", "MPa", "MPa·um²", "MPa·um", "MPa/um", "1/um", "1/MPa"]);
    assert_eq!(names(Units::of_map(Some("m"))), ["m", "", "", "", "", "1/m", ""]);
    assert_eq!(names(Units::default()), [""; 7]);
}

#[test]
fn numbers_and_headers_have_their_units() {
    assert_eq!(Units::si().number(6.273889e-10, LENGTH), "627.4 pm");
    let least = [-1e-25, -9e-22, 1e-21].map(|least| Units::si().number(least, LENGTH));
    assert_eq!(least, ["0 m", "0 m", "1 zm"]);
    assert_eq!(Units::si().number(9.999e14, PRESSURE_PER_LENGTH), "999.9 MPa/µm");
    assert_eq!(Units::si().number(9.9999e14, PRESSURE_PER_LENGTH), "1 GPa/µm");
    assert_eq!(Units::si().number(2.6170857e17, PRESSURE_PER_LENGTH), "261.7 GPa/µm");
    assert_eq!(Units::si().number(0.05, ENERGY_PER_AREA), "50 mJ/m²");
    assert_eq!([-2.5e-22, 0.0, 2e-21].map(|energy| Units::si().number(energy, ENERGY)), ["-2.5e-22 J", "0 J", "2 zJ"]);
    let powers = [
        (1.8e-24, TRANSMISSIVITY, "1800 nm³"),
        (9.9999e-22, TRANSMISSIVITY, "0.001 µm³"),
        (2.5, TRANSMISSIVITY, "2.5 m³"),
        (1e-70, TRANSMISSIVITY, "0 m³"),
        (3.2e-13, AREA, "0.32 µm²"),
        (3.2e-15, AREA, "3200 nm²"),
        (2.34567e7, PER_LENGTH, "23.46 1/µm"),
        (0.0, PER_LENGTH, "0 1/m"),
        (3e-30, PER_LENGTH, "0 1/m"),
        (3e-9, PER_PRESSURE, "3 1/GPa"),
        (3e7, THERMAL_CONDUCTANCE, "30 MW/(m²·K)"),
    ];
    for (value, dimension, text) in powers {
        assert_eq!(Units::si().number(value, dimension), text);
    }
    assert_eq!(units("um", "MPa").number(1.8e-6, TRANSMISSIVITY), "1.8e-6 um³");
    assert_eq!(units("um", "MPa").number(0.5, PRESSURE), "0.5 MPa");
    assert_eq!(Units::default().number(0.5, PRESSURE), "0.5");
    let names = ["control_value", "mean_gap", "elastic_energy", "perimeter", "status"];
    assert_eq!(
        Units::si().columns(&names, "normal-force", false),
        ["control_value [N]", "mean_gap [m]", "elastic_energy [J/m2]", "perimeter [m]", "status"]
    );
    assert_eq!(Units::of_map(Some("m")).columns(&names, "spring", false), names);
}

#[test]
fn names_mean_what_a_command_has() {
    let (one, many) = (["law", "mean-pressure", "approach"], ["law", "mean-pressures", "approaches"]);
    for (name, found) in [
        ("pressure", Some(1)),
        ("pressures", Some(1)),
        ("mean_pressures", Some(1)),
        ("Adhesion", Some(0)),
        ("approaches", Some(2)),
        ("indentation", Some(2)),
        ("poisson", None),
        ("law-table", None),
    ] {
        assert_eq!(meant(name, one), found.map(|found| one[found]), "{name}");
    }
    for (name, found) in [("load", 1), ("mean-pressure", 1), ("approach", 2)] {
        assert_eq!(meant(name, many), Some(many[found]), "{name}");
    }
    assert_eq!(similar("mean-gasp", ["mean-gaps", "law"]), Some("mean-gaps"));
}

#[test]
fn no_word_has_two_meanings() {
    let words: Vec<_> = SYNONYMS.iter().flat_map(|(words, _)| words.split(' ')).collect();
    for (k, word) in words.iter().enumerate() {
        assert!(words[..k].iter().all(|other| !is_same(other, word)), "{word}");
    }
}

fn gaps(text: &str) -> Result<Loads, String> {
    parsed(text, &LENGTH.within(Range::NON_NEGATIVE))
}

fn signed(text: &str) -> Result<Loads, String> {
    parsed(text, &LENGTH.within(Range::FINITE))
}

#[test]
fn lists_are_numbers_and_ranges() {
    let check = |text, expected: &[f64]| assert_eq!(signed(text).unwrap().values, expected, "{text}");
    check("1", &[1.0]);
    check("1e-3, -2,3", &[1e-3, -2.0, 3.0]);
    check("0:1:5", &[0.0, 0.25, 0.5, 0.75, 1.0]);
    check("1:0:3,-1", &[1.0, 0.5, 0.0, -1.0]);
    check("1:200:200", &(1..=200).map(f64::from).collect::<Vec<_>>());
    check("1:16:5:log", &[1.0, 2.0, 4.0, 8.0, 16.0]);
    check("-4:-1:2:log", &[-4.0, -1.0]);
    check("-6nm,0,1nm", &[-6e-9, 0.0, 1e-9]);
    check("1um:4um:3:log", &[1e-6, 2e-6, 4e-6]);
}

#[test]
fn lists_that_are_none_are_refused() {
    for (text, part) in [
        ("", "''"),
        ("1,,2", "''"),
        ("1,", "''"),
        ("one", "'one'"),
        ("nan", "'nan'"),
        ("1,inf", "'inf'"),
        ("-1", "'-1'"),
        ("0.1,-1e-3", "'-1e-3'"),
        ("1:2", "FROM:TO:COUNT"),
        ("1:2:3:4", "FROM:TO:COUNT"),
        ("1:2:3:log:1", "FROM:TO:COUNT"),
        ("1:2:1", "from 2"),
        ("1:2:0", "from 2"),
        ("1:2:-3", "from 2"),
        ("1:2:2.5", "from 2"),
        ("1:2:99999999999999999999", "from 2"),
        ("1:2:100001", "from 2"),
        ("0:1:5:log", ":log"),
        ("1:0:5:log", ":log"),
        ("0:-1:5", "'-1'"),
        ("1nm-2nm", "as 1nm:2nm:10 or"),
        ("1e-3-1e-1", "as 1e-3:1e-1:10 or"),
        ("1..2", "as 1:2:10 or"),
        ("1nm-2N", "nm-2N is no unit"),
        ("1nm,2", "2 has no unit"),
        ("1:2nm:5", "1 has no unit"),
        ("1nm:2nN:5", "'2nN'"),
    ] {
        let error = gaps(text).unwrap_err();
        assert!(error.contains(part) && error.lines().count() == 1, "{text}: {error}");
    }
    let refused = signed("-1:1:5:log").unwrap_err();
    assert!(refused.contains(":log"), "{refused}");
    let many = ["0:1:100000"; 2].join(",");
    assert!(gaps(&many).unwrap_err().contains("more loads than the 100000"));
    assert!(signed("-1e308:1e308:3").unwrap_err().contains("finite"));
}

#[test]
fn a_steady_fall_tells_its_rate_and_the_time_that_is_left() {
    let mut fall = Fall::default();
    for k in 0..3 {
        fall.next((0, false), k, 0.5_f64.powi(k as i32), 0.1 * k as f64);
        assert_eq!(fall.rate(1e-3), None);
    }
    for k in 3..9 {
        fall.next((0, false), k, 0.5_f64.powi(k as i32), 0.1 * k as f64);
    }
    // from 2⁻⁸ to 2⁻¹⁰ in two iterations of 0.1 s
    let (factor, seconds) = fall.rate(0.5_f64.powi(10)).unwrap();
    assert!((factor - 2.0).abs() < 1e-12 && (seconds - 0.2).abs() < 1e-12);
    assert_eq!(fall.describe(0.5_f64.powi(10)), ", 2.00 times smaller in an iteration, 0.2 s left");
    assert_eq!(fall.rate(0.1).unwrap().1, 0.0);
    // another law is another error, and one that grows tells nothing
    fall.next((1, false), 9, 1.0, 0.9);
    assert_eq!(fall.describe(1e-3), "");
    (10..20).for_each(|k| fall.next((1, false), k, k as f64, 0.1 * k as f64));
    assert_eq!(fall.describe(1e-3), "");
    assert_eq!([5.0, 60.0, 600.0, 9000.0].map(time), ["5.0 s", "60 s", "10 min", "2.5 h"]);
}

#[test]
fn the_pace_of_a_cycle_tells_the_time_that_is_left() {
    // two states were there, with one event; 101 there are at least
    let settings = PathSettings::default();
    let begun = Pace::new(2, &settings);
    let mut pace = begun.behind(2, 1);
    assert_eq!((pace.seconds_left(), pace.forecast()), (None, None));
    pace.begin(0.2);
    pace.add(0.21, false, 2.0);
    assert_eq!(pace.seconds_left(), None);
    // from a twentieth of the way on by the speed
    pace.add(0.4, true, 4.0);
    assert!((pace.seconds_left().unwrap() - 18.0).abs() < 1e-12);
    assert_eq!(pace.describe(), "4 states, 2 events, 40 % of the way, about 18 s left");
    // before the first state by the time of an operator application, and then more and more by the speed
    let mut fresh = begun;
    assert_eq!((fresh.seconds_left(), fresh.forecast()), (None, None));
    fresh.expect(1e-3, false);
    assert_eq!(fresh.describe(), "0 states, 0 events, 0 % of the way, about 6.1 s left");
    assert_eq!(fresh.forecast().unwrap(), "101 states or more, 2 legs of 50 steps: about 6.1 s");
    assert_eq!(fresh.behind(3, 0).forecast(), None);
    let mut short = Pace::new(1, &settings.steps(1));
    short.expect(0.005, true);
    assert_eq!(short.forecast().unwrap(), "2 states or more, 1 leg of 1 step: about 60 s");
    short.add(0.5, false, 10.0);
    assert_eq!(short.seconds_left(), Some(0.5 * (0.5 * 60.0 + 0.5 * 20.0)));
    let mut endless = Pace::new(1, &settings.steps(usize::MAX));
    endless.expect(1e-3, false);
    assert!(endless.forecast().unwrap().starts_with(&format!("{} states or more", usize::MAX)));
    fresh.add(0.0, false, 0.5);
    assert_eq!(fresh.forecast(), None);
    // past a limit point the load falls again, the way does not
    fresh.add(0.5, false, 0.5);
    fresh.add(0.4, false, 0.5);
    assert_eq!(fresh.share(), 0.5);
}

#[test]
fn an_axis_is_logarithmic_where_values_are_spread_so() {
    let rows = |values: &[f64]| values.iter().map(|value| json!({ "mean_gap": value })).collect::<Vec<_>>();
    let log = |values: &[f64]| logarithmic(&rows(values), "mean_gap", "mean_gap") == [true; 2];
    assert!(log(&[0.01, 0.02, 0.04, 0.08, 0.15, 0.3]) && log(&[1.0, 10.0]) && log(&[1.0, 3.0, 10.0, f64::NAN]));
    assert!(!log(&[0.01, 0.11, 0.21, 0.31]) && !log(&[1.0, 3.0, 9.0]) && !log(&[0.0, 0.1, 1.0, 10.0]));
    assert!(!log(&[-1.0, 0.1, 1.0, 10.0]) && !log(&[f64::NAN]));
    // but not of a cycle
    let rows = |leg: Value| -> Vec<Value> {
        let row = |load: f64| json!({ "leg": leg, "mean_gap": load, "mean_pressure": load });
        [0.01, 0.02, 0.05, 0.1, 0.2].map(row).to_vec()
    };
    assert_eq!(logarithmic(&rows(Value::Null), "mean_gap", "mean_pressure"), [true; 2]);
    assert_eq!(logarithmic(&rows(1.into()), "mean_gap", "mean_pressure"), [false; 2]);
}

#[test]
fn the_cases_of_a_study_are_named_by_what_varies() {
    let rows = |cases: &[(u64, f64)]| -> Vec<Value> {
        let row = |(k, (case, hurst)): (usize, &(u64, f64))| json!({ "case": case, "hurst": hurst, "seed": case, "control": "mean-gap", "control_value": k % 2 });
        cases.iter().enumerate().map(row).collect()
    };
    let over = |rows: &[Value], x: &str| -> Vec<(String, Vec<usize>)> {
        let told = |column: &str, value: f64| format!("{value}{}", if column == "hurst" { " H" } else { "" });
        let count = |leg: Leg<'_>| {
            let dash = if leg.dash.is_empty() { String::new() } else { format!("; {}", leg.dash) };
            (leg.colour + &dash, leg.parts.iter().map(Vec::len).collect())
        };
        legs(rows, x, told).into_iter().map(count).collect()
    };
    let found = |rows: &[Value]| over(rows, "mean_gap");
    let name = |text: &str, parts: &[usize]| (text.to_owned(), parts.to_vec());
    let two = [name("hurst 0.5 H, seed 1", &[2]), name("hurst 0.8 H, seed 2", &[2])];
    assert_eq!(found(&rows(&[(1, 0.5), (1, 0.5), (2, 0.8), (2, 0.8)])), two);
    assert_eq!(found(&rows(&[(1, 0.5), (1, 0.5)])), [name("", &[2])]);
    // more than there are colours: by the columns with few values, but not by the seed
    let many: Vec<_> = (1..10).map(|seed| (seed, if seed < 6 { 0.5 } else { 0.8 })).collect();
    assert_eq!(found(&rows(&many)), [name("hurst 0.5 H", &[1; 5]), name("hurst 0.8 H", &[1; 4])]);
    let seeds: Vec<_> = (1..10).map(|seed| (seed, 0.5)).collect();
    assert_eq!(found(&rows(&seeds)), [name("", &[1; 9])]);
    // of two keys one is told by the colour and the other by the dash, whatever a law brings with it
    let crossed: Vec<Value> = (0..6).map(|k| json!({ "case": k, "hurst": (0.2 + 0.3 * (k % 3) as f64), "law": (["none", "jkr"][k / 3]), "work": ([Value::Null, 1.into()][k / 3]), "control": "mean-gap" })).collect();
    let legs = ["0.2", "0.5", "0.8"].map(|hurst| format!("hurst {hurst} H"));
    let of = |law: &str| legs.iter().map(|hurst| name(&format!("{hurst}; {law}"), &[1])).collect::<Vec<_>>();
    assert_eq!(found(&crossed), [of("law none"), of("law jkr, work 1")].concat());
    // where cases have a row each, what varies is below
    assert_eq!(abscissa(&crossed), Some("hurst"));
    assert_eq!(over(&crossed, "hurst"), [name("law none", &[3]), name("law jkr, work 1", &[3])]);
    assert_eq!((abscissa(&rows(&many)), abscissa(&rows(&[(1, 0.5), (1, 0.5), (2, 0.8)]))), (Some("hurst"), None));
}
