//! Units in what the tool prints.

use crate::bench::Bench;

#[test]
fn the_table_of_a_solve_in_metres_and_pascals_has_prefixes() {
    let bench = Bench::new();
    bench.said("surface --size 32 --lengths 1e-6 --k-s 10 --rms-height 5e-9 --quiet --out heights.npy");
    let solve = "solve --heights heights.npy --lengths 1e-6 --modulus 1e9 --mean-pressure 5e6 --no-pictures --force";
    // the number after a name in the table, and what follows
    let cell = |table: &str, name: &str| {
        let line = table.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("no {name}: {table}"));
        let mut words = line[name.len()..].split_whitespace().map(str::to_owned);
        (words.next().unwrap().parse::<f64>().unwrap(), words.collect::<Vec<_>>().join(" "))
    };
    let table = bench.said(&format!("{solve} --length-unit m --pressure-unit Pa --out si"));
    let gap = bench.report("si")["mean_gap"].as_f64().unwrap();
    let (number, unit) = cell(&table, "mean gap");
    assert_eq!(unit, "nm");
    // four digits
    assert!((1e-9 * number / gap - 1.0).abs() < 1e-3, "{number} {gap}");
    assert_eq!(cell(&table, "mean pressure"), (5.0, "MPa".to_owned()));
    assert_eq!(cell(&table, "normal force"), (5.0, "µN".to_owned()));
    // units that are not known, or only in part
    for units in ["", "--length-unit m", "--pressure-unit Pa", "--length-unit mm --pressure-unit MPa"] {
        let table = bench.said(&format!("{solve} {units} --out plain"));
        assert_eq!(cell(&table, "mean pressure"), (5e6, String::new()), "{units}");
    }
}
