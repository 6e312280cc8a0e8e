//! Units in what the tool prints.

use asperity_maps::io::{read_topography, write_topography};
use serde_json::Value;

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
    // without adhesion nothing is said of it
    assert!(!table.contains("adhesive") && !table.contains("mu_rho"), "{table}");
    // with a law all is said, be it zero
    let table = bench.said(&format!("{solve} --law exponential --work-of-adhesion 0 --range 1e-9 --out nothing"));
    assert_eq!((cell(&table, "adhesive energy per area").0, cell(&table, "mu_rho").0), (0.0, 0.0));
    let table = bench.said(&format!("{solve} --length-unit mm --pressure-unit MPa --out plain"));
    assert_eq!((cell(&table, "mean gap").1, cell(&table, "mean pressure").1), ("mm".to_owned(), "MPa".to_owned()));
}

const PLAIN: &str =
    "--lengths 1e-6 --modulus 1e9 --mean-pressure 5e6 --law exponential --work-of-adhesion 0.05 --range 2.5e-9";
const UNITS: &str =
    "--lengths 1um --modulus 1GPa --mean-pressure 5MPa --law exponential --work-of-adhesion 50mJ/m2 --range 2.5nm";

fn rough() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 32 --lengths 1um --k-s 10 --rms-height 5nm --quiet --out heights.npy");
    bench
}

#[test]
fn the_distribution_of_the_pressure_has_units_and_integrates_to_the_contact() {
    let bench = rough();
    let solve = format!("solve --heights heights.npy {UNITS} --no-pictures --quiet --force --out spread");
    bench.said(&format!("{solve} --distribution 20"));
    let text = bench.read("spread/distribution.csv");
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let integral: f64 = rows.iter().map(|row| row[2] * (row[1] - row[0])).sum();
    let header = "from_pressure [Pa],to_pressure [Pa],density [1/Pa]";
    assert_eq!((text.lines().next(), rows.len(), rows[0][0]), (Some(header), 20, 0.0));
    // tension is in no bin
    let contact = bench.report("spread")["contact_fraction"].as_f64().unwrap();
    assert!((integral - contact).abs() < 1e-12 && integral > 0.0);
    bench.said("run spread/scene.toml --quiet --force --out again");
    assert_eq!(bench.read("again/distribution.csv"), text);
    let refused = bench.refused("solve --heights heights.npy --mean-gap 0.5 --out none --distribution 0");
    assert!(refused.contains("from 1 to 1000000"), "{refused}");
}

#[test]
fn numbers_with_units_are_those_in_the_si() {
    let bench = rough();
    bench.said(&format!("solve --heights heights.npy {PLAIN} --quiet --out plain"));
    let table = bench.said(&format!("solve --heights heights.npy {UNITS} --out units"));
    for field in ["gap.npy", "pressure.npy", "contact_pressure.npy"] {
        assert!(bench.bytes(&format!("plain/{field}")) == bench.bytes(&format!("units/{field}")), "{field}");
    }
    assert!(
        ["mean pressure             5 MPa", "normal force              5 µN"].iter().all(|row| table.contains(row)),
        "{table}"
    );
    let (plain, units) = (bench.report("plain"), bench.report("units"));
    for (key, here) in units.as_object().unwrap() {
        match key.as_str() {
            "seconds" => {}
            "length_unit" => assert_eq!((here, &plain[key]), (&"m".into(), &Value::Null)),
            "pressure_unit" => assert_eq!((here, &plain[key]), (&"Pa".into(), &Value::Null)),
            "given" => {
                assert_eq!(plain[key], Value::Null);
                assert_eq!((&here["modulus"], &here["work_of_adhesion"]), (&"1GPa".into(), &"50mJ/m2".into()));
            }
            _ => assert_eq!(here, &plain[key], "{key}"),
        }
    }
    // as they were typed, and for hands that write a scene
    let scene = bench.read("units/scene.toml");
    assert!(
        ["modulus = \"1GPa\"", "lengths = \"1um\"", "mean-pressure = \"5MPa\""].iter().all(|line| scene.contains(line))
    );
    bench.said("run units/scene.toml --mean-pressure 6MPa --quiet --out more");
    assert_eq!(bench.report("more")["mean_pressure"].as_f64(), Some(6e6));
    bench.refused_with(
        "run units/scene.toml --mean-pressure 6e6 --out no",
        &["--mean-pressure is 6e6", "--lengths 1um"],
    );
}

#[test]
fn units_belong_to_all_numbers_or_to_none() {
    let bench = rough();
    let solve = "solve --heights heights.npy --out no";
    for (arguments, parts) in [
        (
            "--lengths 1um --modulus 1GPa --mean-pressure 1MPa --length-unit nm",
            vec!["--length-unit is nm", "m already"],
        ),
        (
            "--mean-pressure 1e-3 --length-unit nm --pressure-unit GPa --force-unit N",
            vec!["--force-unit is N", "lengths in nm and pressures in GPa", "1 nN"],
        ),
    ] {
        bench.refused_with(&format!("{solve} {arguments}"), &parts);
    }
    let sweep = "sweep --heights heights.npy --lengths 1um --modulus 1GPa --out no.csv --mean-pressures";
    bench.refused_with(&format!("{sweep} 1:2MPa:3"), &["1 has no unit"]);
    bench.refused_with(&format!("{sweep} 1nm:2nm:3"), &["'1nm'", "pressure"]);
    // zero has the same size in every unit
    bench.said(&format!("{sweep} 0,1MPa --quiet").replace("no.csv", "zero.csv"));
    assert!(!bench.path("no").exists() && !bench.path("no.csv").exists());
}

#[test]
fn tables_name_the_units_of_their_columns() {
    let bench = rough();
    let sweep = "sweep --heights heights.npy --lengths 1um --modulus 1GPa --out sweep.csv";
    let said = bench.said(&format!("{sweep} --mean-pressures 1MPa:4MPa:3:log --stiffness"));
    assert!(said.contains("mean pressure 2 MPa  mean gap ") && said.contains(" nm  contact"), "{said}");
    let table = bench.read("sweep.csv");
    let header = table.lines().next().unwrap();
    assert_eq!(
        header,
        "control,control_value [Pa],mean_pressure [Pa],mean_contact_pressure [Pa],mean_gap [m],normal_force [N],approach [m],\
         edge_traction,contact_fraction,corrected_contact_fraction,perimeter [m],clusters,largest_cluster,repulsive_fraction,\
         attractive_fraction,elastic_energy [J/m2],adhesive_energy [J/m2],min_gap [m],relative_error,load_error,iterations,\
         operator_applications,status,modulus [Pa],law,work_of_adhesion [J/m2],range [m],heights,part,seed,contact_stiffness [Pa/m],normal_stiffness [N/m]"
    );
    assert!(table.lines().nth(1).unwrap().starts_with("mean-pressure,1000000.0,1000000.0,"), "{table}");
    // a table continues in its own units only, which are the SI's either way
    let more = "--mean-pressures 1MPa:4MPa:3:log,5MPa --stiffness";
    assert!(bench.said(&format!("{sweep} {more} --plot area.svg")).contains("3 of 4 rows already"));
    assert!(bench.read("area.svg").contains(">mean pressure (MPa)<"));
    let plain = "sweep --heights heights.npy --lengths 1e-6 --modulus 1e9 --out sweep.csv --stiffness --mean-pressures";
    bench.refused_with(&format!("{plain} 1e6:4e6:3:log,5e6"), &["units is m Pa N, and not none"]);
    bench.said(&format!("{plain} 1e6:4e6:3:log,5e6 --length-unit m --pressure-unit Pa --quiet"));
    // the page takes the units from the header
    bench.said("report sweep.csv");
    let page = bench.read("sweep.csv.html");
    assert!(page.contains("<td>1 MPa</td>") && page.contains(">mean pressure (MPa)<"), "{page}");

    let tip = "surface --form sphere --radius 20nm --size 48 --lengths 20nm --quiet --out tip.npz";
    bench.said(tip);
    let said = bench.said(
        "cycle --heights tip.npz --boundary free --modulus 2GPa --law exponential --work-of-adhesion 50mJ/m2 --range 0.3nm \
         --spring-stiffness 2N/m --spring-positions=-4nm,0,-12nm --steps 10 --smallest-step 1e-3 --out tip.csv --plot tip.svg",
    );
    assert!(said.contains("normal force 0 N") || said.contains(" nN  approach -"), "{said}");
    assert!(
        said.contains("greatest tensile force  ")
            && said.contains("energy drop ")
            && !said.contains("J/m²")
            && said.contains(" aJ"),
        "{said}"
    );
    assert!(bench.read("tip.csv").starts_with("leg,direction,control,control_value [m],"));
    assert!(bench.read("tip.svg").contains(">normal force (nN)<"));
    // what an AFM draws first, and energies of a tip in full
    bench.said("report tip.csv");
    let page = bench.read("tip.csv.html");
    let charts =
        ["Normal force over position of the spring", "Normal force over approach", "Dissipated energy over approach"];
    let places: Vec<_> = charts.iter().map(|title| page.find(&format!(">{title}<")).unwrap()).collect();
    assert!(places.is_sorted() && page.contains(">dissipated energy (aJ)<"), "{places:?}");
    assert!(page.contains("<th>pull-off force</th>") && page.contains("<th>dissipated energy</th>"));
}

#[test]
fn maps_have_their_unit_and_come_into_the_si() {
    let bench = Bench::new();
    // 5 by 4 micrometres, and heights in nanometres
    let row = |i: usize| {
        (0..24)
            .map(|j| (30.0 * (0.7 * i as f64).sin() * (0.6 * j as f64).cos()).to_string())
            .collect::<Vec<_>>()
            .join(" ")
    };
    bench.write("heights.txt", &(0..30).map(row).collect::<Vec<_>>().join("\n"));
    let said = bench.said("prepare heights.txt --lengths 5um 4um --unit nm --mirror --out map.npz");
    assert!(said.contains("5000 nm x 4000 nm, before unknown"), "{said}");
    let map = read_topography(bench.path("map.npz")).unwrap();
    assert_eq!((map.lengths, map.unit.as_deref()), (Some((10000.0, 8000.0)), Some("nm")));
    assert!(bench.said("stats map.npz").contains("side lengths             10000 nm x 8000 nm"));
    let solved = bench.reported("solve --heights map.npz --modulus 1GPa --mean-pressure 1MPa --no-pictures --out si");
    assert_eq!((&solved["lengths"], &solved["length_unit"]), (&serde_json::json!([5e-6, 4e-6]), &"m".into()));
    let mut metres = map.clone();
    metres.heights.mapv_inplace(|height| height / 1e9);
    (metres.lengths, metres.unit) = (Some((1e-5, 8e-6)), Some("m".to_owned()));
    write_topography(bench.path("metres.npz"), &metres).unwrap();
    bench.said("solve --heights metres.npz --modulus 1e9 --mean-pressure 1e6 --no-pictures --quiet --out plain");
    assert!(bench.bytes("si/gap.npy") == bench.bytes("plain/gap.npy"));
    // the unit may stand in a comment
    bench.write("said.txt", &format!("# heights in nm\n{}", (0..30).map(row).collect::<Vec<_>>().join("\n")));
    bench.said("prepare said.txt --lengths 5um 4um --mirror --out said.npz");
    assert!(bench.bytes("said.npz") == bench.bytes("map.npz"));
    // in whatever unit the map is, if numbers have none
    let plain = bench.reported("solve --heights map.npz --modulus 1 --mean-pressure 1e-3 --no-pictures --out nm");
    assert_eq!((&plain["lengths"][0], &plain["length_unit"]), (&5000.0.into(), &"nm".into()));
    bench.said("prepare heights.txt --lengths 5000 4000 --unit px --out px.npz");
    bench.refused_with(
        "solve --heights px.npz --modulus 1GPa --mean-pressure 1MPa --out no",
        &["in px", "prepare --unit"],
    );
    bench.refused_with("prepare px.npz --lengths 5um --out no.npz", &["in px", "--unit"]);
    // what is made with units has them in its file
    assert!(
        bench
            .said("surface --size 16 --lengths 2um --k-s 6 --rms-height 5nm --out made.npz")
            .contains("rms height               5 nm")
    );
    assert_eq!(read_topography(bench.path("made.npz")).unwrap().unit.as_deref(), Some("m"));
    bench.refused_with("surface --size 16 --k-s 6 --rms-height 5nm --out no.npz", &["how large", "--lengths"]);
}
