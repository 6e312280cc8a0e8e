//! Pictures in their formats, and the page of `asperity report`.

use asperity::contact::Clusters;
use asperity_maps::io::{read_field, write_npy};
use asperity_plot::LoadScale;

use crate::bench::{Bench, text};

const LAW: &str = "--law exponential --work-of-adhesion 1e-4 --range 8e-3";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 32 --k-l 2 --k-s 8 --rms-height 0.01 --out heights.npy --quiet");
    bench
}

/// The sides of a PNG file in pixels.
fn sides(bytes: &[u8]) -> [u32; 2] {
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
}

#[test]
fn pictures_come_in_the_format_and_the_resolution_that_is_asked_for() {
    let bench = bench();
    let solve = format!("solve --heights heights.npy --mean-pressure 0.01 {LAW} --quiet");
    bench.said(&format!("{solve} --out png"));
    bench.said(&format!("{solve} --dpi 288 --colour-limits -1 1 --out fine"));
    for name in ["contact.png", "pressure.png"] {
        let [usual, fine] = ["png", "fine"].map(|folder| sides(&bench.bytes(&format!("{folder}/{name}"))));
        assert!(usual[0] > 600, "{usual:?}");
        // the numbers at the colour bars may be of other widths
        assert!(fine[1] == 2 * usual[1] && fine[0].abs_diff(2 * usual[0]) < 100, "{usual:?} {fine:?}");
    }
    bench.said(&format!("{solve} --dpi 300 --width 85mm --out column"));
    bench.said("sweep --heights heights.npy --mean-pressures 0.01,0.02 --out t.csv --plot t.png --width 65mm --quiet");
    for (file, millimetres) in [("column/contact.png", 85.0), ("column/pressure.png", 85.0), ("t.png", 65.0)] {
        let dots = if file == "t.png" { 144.0 } else { 300.0 };
        let [width, _] = sides(&bench.bytes(file));
        // of whole points
        assert!((f64::from(width) - millimetres / 25.4 * dots).abs() < dots / 72.0, "{file}: {width}");
    }
    bench.said(&format!("{solve} --picture-format svg --pressure-unit Pa --length-unit m --out svg"));
    let names = bench.names("svg");
    assert!(names.contains(&"contact.svg".to_owned()) && !names.contains(&"contact.png".to_owned()), "{names:?}");
    let (contact, pressure) = (bench.read("svg/contact.svg"), bench.read("svg/pressure.svg"));
    for word in [">contact</text>", ">attractive</text>", ">apart</text>", "data:image/png;base64,"] {
        assert!(contact.contains(word), "{word}");
    }
    // each of the two with its own scale
    assert!([">tension (", ">compression ("].iter().all(|word| pressure.contains(word)));
    assert!(contact.contains("% contact") && contact.contains("% attractive"));
    bench.said(&format!("{solve} --picture-format pdf --out pdf"));
    assert!(bench.bytes("pdf/pressure.pdf").starts_with(b"%PDF-1."));

    bench.refused_with(&format!("{solve} --out no --colour-limits 2 1"), &["--colour-limits", "first"]);
    bench.refused_with(&format!("{solve} --out no --colour-limits 1 2"), &["--colour-limits 1 2", "zero"]);
    bench.refused_with(&format!("{solve} --out no --dpi 10"), &["--dpi", "from 36 to 1200"]);
    for width in ["85", "1mm", "85kg"] {
        bench.refused_with(&format!("{solve} --out no --width {width}"), &["--width", "with a unit, from 65mm to 2m"]);
    }
    assert!(!bench.path("no").exists());
}

#[test]
fn scars_do_not_hide_the_contact_and_clusters_have_colours() {
    let bench = bench();
    let mut heights = read_field(bench.path("heights.npy")).unwrap();
    // high enough to press far harder than the contact next to it
    (4..12).for_each(|i| heights[[i, 20]] = 0.04);
    write_npy(bench.path("scarred.npy"), &heights).unwrap();
    let solve = "solve --heights scarred.npy --mean-pressure 0.02 --pressure-unit Pa --picture-format svg";
    let warned = |arguments: &str| {
        let run = bench.run(arguments);
        assert_eq!(run.status.code(), Some(0), "{arguments}");
        text(&run.stdout)
    };
    let said = warned(&format!("{solve} --out plain"));
    let pressures = read_field(bench.path("plain/contact_pressure.npy")).unwrap();
    let scale = LoadScale::from_values(&pressures, None);
    assert!(scale.end < 0.7 * scale.greatest && scale.beyond > 0.05, "{scale:?}");
    let caption = format!("{:.0} % of the load is carried above", 100.0 * scale.beyond);
    bench.said("report plain");
    for picture in ["plain/pressure.svg", "plain/report.html"] {
        assert!(bench.read(picture).contains(&caption), "{picture}: {caption}");
    }
    assert!(said.contains(&format!("beyond the colours of the pressure: {caption}")), "{said}");
    assert!(bench.read("plain/pressure.svg").contains(">max "));
    // all of it on demand, and clusters in the number of the table
    let clusters = Clusters::of(pressures.mapv(|pressure| pressure > 0.0).view()).sizes.len();
    let caption = format!("in {clusters} clusters, the largest with ");
    let said = warned(&format!("{solve} --colour-limits 0 10 --colour-clusters --out limited"));
    assert!(!said.contains("beyond the colours"), "{said}");
    bench.said("report plain --colour-limits 0 10 --colour-clusters --force");
    assert!(bench.read("limited/contact.svg").contains(&caption));
    let page = bench.read("plain/report.html");
    assert!(page.contains(&caption) && !page.contains("of the load is carried above"));
    assert!(!bench.read("limited/pressure.svg").contains(">max "));

    bench.refused_with("report plain --colour-limits 2 1 --force", &["--colour-limits", "first"]);
    bench.said("sweep --heights heights.npy --mean-pressures 0.01 --quiet --out area.csv");
    bench.refused_with("report area.csv --colour-clusters", &["area.csv", "no maps", "--colour-clusters"]);
    bench.said("solve --heights heights.npy --mean-pressure 0.01 --no-pictures --quiet --out bare");
    bench.refused_with("report bare --colour-limits 0 1GPa", &["--colour-limits", "not in Pa"]);
}

#[test]
fn a_sweep_has_a_chart_of_its_loads() {
    let bench = bench();
    let sweep = "sweep --heights heights.npy --quiet --mean-pressures 1e-4:1e-1:4:log --out area.csv";
    bench.said(&format!("{sweep} --plot area.svg --pressure-unit Pa"));
    let chart = bench.read("area.svg");
    assert!([">mean pressure (", ">contact fraction<"].iter().all(|label| chart.contains(label)), "{chart}");
    // at least three numbers on each of the two logarithmic axes
    for anchor in ["middle", "end"] {
        let numbers = chart.lines().filter(|line| line.contains(&format!("font-size=\"8\" text-anchor=\"{anchor}\"")));
        assert!(numbers.filter(|line| !line.contains("\"></text>")).count() >= 3, "{anchor}: {chart}");
    }
    bench.said(&format!("{sweep} --plot area.pdf"));
    assert!(bench.bytes("area.pdf").starts_with(b"%PDF-1."));
    bench.write("there.png", "");
    let other = sweep.replace("area.csv", "b.csv");
    bench.refused_with(&format!("{other} --plot there.png"), &["there.png", "exists", "--plot"]);
    bench.refused_with(&format!("{other} --plot a.jpg"), &["a.jpg", ".png, .svg or .pdf"]);
    assert!(!bench.path("b.csv").exists());
}

/// The names of the tags that are open at the end, or cross each other; nothing but the text between tags is looked at.
fn unbalanced(page: &str) -> Vec<String> {
    let (before, script) = page.split_once("<script>").unwrap();
    let (_, after) = script.split_once("</script>").unwrap();
    let mut open: Vec<String> = Vec::new();
    for piece in [before, after].concat().split('<').skip(1) {
        let tag = &piece[..piece.find('>').unwrap_or_else(|| panic!("an open tag: {piece:.60}"))];
        let name = tag.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap().to_owned();
        match tag {
            _ if tag.starts_with('!') || tag.ends_with('/') => {}
            _ if tag.starts_with('/') && open.last() == Some(&name) => {
                open.pop();
            }
            _ => open.push(name),
        }
    }
    open
}

/// What a page would load: all addresses in attributes and styles that are not in the page itself.
fn loaded(page: &str) -> Vec<&str> {
    let places = ["src=\"", "href=\"", "url(", "@import"];
    let found = places.iter().flat_map(|place| page.match_indices(place).map(|(at, place)| &page[at + place.len()..]));
    found
        .filter(|rest| !rest.starts_with("data:") && !rest.starts_with('#'))
        .map(|rest| &rest[..rest.len().min(60)])
        .collect()
}

#[test]
fn a_report_is_one_page_that_loads_nothing() {
    let bench = bench();
    let units = "--length-unit m --pressure-unit Pa";
    let solve = format!("solve --heights heights.npy --mean-pressure 0.01 {LAW} {units} --no-pictures --quiet");
    bench.said(&format!("{solve} --out results"));
    bench.said("report results");
    let page = bench.read("results/report.html");
    assert_eq!((unbalanced(&page), loaded(&page)), (vec![], vec![]));
    // the figures come first, and the slopes as in the report and in `stats`
    assert!(page.find("<h2>Numbers").unwrap() < page.find("<h2>Maps").unwrap());
    let (found, stats) = (bench.report("results"), bench.reported("stats heights.npy --lengths 1"));
    for (key, name) in [("rms_slope", "rms slope"), ("rms_slope_differences", "rms slope differences")] {
        assert_eq!(found[key], stats[key], "{key}");
        assert!(page.contains(&format!("<th>{name}</th>")), "{key}");
    }
    assert_eq!(
        (page.matches("<figure class=\"map\" data-map=").count(), page.matches("<figure class=\"chart\">").count()),
        (3, 2)
    );
    let scene = bench.read("results/scene.toml").replace('"', "&quot;");
    for part in [
        ">attractive<",
        "<h2>Scene</h2>",
        ">tension (",
        "<h3>Contact</h3>",
        "mean pressure, given",
        "<td>converged</td>",
        &scene,
    ] {
        assert!(page.contains(part), "{part}");
    }
    // how to cite, as in the file for programs that cite
    let cited = page.split("<h2>How to cite</h2>").nth(1).unwrap();
    let file = include_str!("../../CITATION.cff");
    let values = file.lines().filter_map(|line| line.trim_start_matches([' ', '-']).split_once(": "));
    let keys = ["name", "version", "family-names", "journal", "volume", "year", "doi"];
    let values: Vec<_> = values.filter(|(key, _)| keys.contains(key)).collect();
    assert!(values.len() >= 9, "{values:?}");
    for (key, value) in values {
        assert!(cited.contains(value), "{key}: {value}");
    }
    bench.refused_with("report results", &["report.html", "exists", "--force"]);
    // a solve that has not converged says so at once, as do its warnings
    let hasty = bench.run(&format!("{solve} --max-iterations 1 --format npz --out hasty"));
    assert_eq!(hasty.status.code(), Some(2), "{}", text(&hasty.stderr));
    bench.said("report hasty --out hasty.html");
    let page = bench.read("hasty.html");
    assert!(page.find("has not converged").unwrap() < page.find("<h2>Numbers").unwrap() && page.contains("no maps"));
    assert_eq!(unbalanced(&page), Vec::<String>::new());

    let cycle = format!("cycle --heights heights.npy {LAW} --mean-gaps 0.04,0.03,0.04 --steps 3 --quiet --out c.csv");
    bench.said(&cycle);
    bench.said("sweep --heights heights.npy --mean-gaps 0.04:0.03:3 --quiet --out s.jsonl");
    for (table, command) in [("c.csv", "asperity cycle"), ("s.jsonl", "asperity sweep")] {
        bench.said(&format!("report {table}"));
        let page = bench.read(&format!("{table}.html"));
        assert_eq!((unbalanced(&page), loaded(&page)), (vec![], vec![]));
        assert!(page.contains(command) && page.contains("<th>mean gap</th>") && page.contains("doi:10.1007"));
        // what is asked first of a cycle, and what is the same in all rows, folded away
        let asked = ["<th>greatest tension</th>", "<th>jumps</th>", "<th>dissipated energy per area</th>"];
        assert!(asked.iter().all(|head| page.contains(head) == (table == "c.csv")), "{table}");
        let folded = page.split("<summary>The same in all rows</summary>").nth(1).unwrap();
        assert!(folded.contains("<th>modulus</th>") && !folded.contains("<th>mean gap</th>"));
        let rows = bench.read(table).lines().count();
        assert!(page.matches("<tr").count() >= rows, "{table}");
    }
    bench.refused_with("report nothing", &["nothing", "folder of results"]);
    bench.refused_with("report heights.npy", &["heights.npy"]);
}

/// The page of results, whole and loading nothing.
fn page(bench: &Bench, results: &str, page: &str) -> String {
    bench.said(&format!("report {results} --force"));
    let page = bench.read(page);
    assert_eq!((unbalanced(&page), loaded(&page)), (vec![], vec![]), "{results}");
    page
}

#[test]
fn what_follows_a_solve_has_its_own_page() {
    let bench = Bench::new();
    bench.said("surface --size 64 --lengths 20um --k-l 2 --k-s 8 --rms-height 0.1um --quiet --out heights.npz");
    let pressed = "--heights heights.npz --modulus 1GPa --mean-pressure 4MPa";
    bench.said(&format!("solve {pressed} --no-pictures --quiet --out pressed"));
    let said = bench.said("leak pressed --viscosity 1mPas --out leaked");
    let leaked = page(&bench, "leaked", "leaked/report.html");
    let figures = said.lines().filter_map(|line| line.split_once("  ")).filter(|(name, _)| !name.is_empty());
    for (name, value) in figures.map(|(name, value)| (name.trim(), value.trim())) {
        assert!(leaked.contains(&format!("<td>{value}</td>")), "{name} {value}");
    }
    assert!(leaked.contains("asperity leak, version") && leaked.contains(">Flow along x<"));
    assert_eq!((leaked.matches("<figure class=\"map\"").count(), leaked.contains("has not converged")), (2, false));
    // bounds that are not as close as they should be
    bench.run("leak pressed --max-iterations 1 --tolerance 1e-9 --quiet --out wide");
    assert!(page(&bench, "wide", "wide/report.html").contains("the bounds of the transmissivity hold, but"));

    bench.said("contact pressed --picture-format svg --quiet --out tables");
    let tables = page(&bench, "tables", "tables/report.html");
    assert!(tables.contains("correlation length") && !tables.contains("has not converged"));
    // the charts of the folder
    for name in ["gap", "pressure", "autocorrelation", "clusters"] {
        assert!(tables.contains(&bench.read(&format!("tables/{name}.svg"))), "{name}");
    }

    let law = "--law exponential --work-of-adhesion 20mJ/m2 --range 20nm";
    let found = bench.reported(&format!("pull-off --heights heights.npz --modulus 1GPa {law} --out off"));
    assert_eq!(bench.names("off").join(" "), "contact_pressure.npy gap.npy pressure.npy report.json scene.toml");
    assert_eq!(bench.report("off"), found);
    let off = page(&bench, "off", "off/report.html");
    assert_eq!(off.matches("<figure class=\"map\"").count(), 3);
    assert!(off.find("<h3>Pull-off</h3>").unwrap() < off.find("<h3>Contact</h3>").unwrap());
    bench.refused_with(
        &format!("pull-off --heights heights.npz --modulus 1GPa {law} --out off"),
        &["exists: use --force"],
    );
    assert_eq!(bench.reported("run off/scene.toml --force")["pull_off_force"], found["pull_off_force"]);

    // a law of an interface, with what is asked for, and all of it in curves
    let loads = "--mean-pressures 1MPa:8MPa:3 --conductivities 1W/mK 1W/mK --leakage";
    bench.said(&format!("interface --heights heights.npz --modulus 1GPa {loads} --quiet --out joint.csv"));
    let joint = page(&bench, "joint.csv", "joint.csv.html");
    for title in
        ["Mean pressure over closure", "Thermal conductance over mean pressure", "Transmissivity over mean pressure"]
    {
        assert!(joint.contains(&format!("<title>{title}</title>")), "{title}");
    }
    assert!(joint.contains("asperity interface: 3 rows") && joint.contains(">along y<"));
    std::fs::create_dir(bench.path("other")).unwrap();
    bench.write("other/report.json", "{\"command\": \"stats\"}");
    bench.refused_with("report other", &["asperity stats", "no page"]);
}

#[test]
fn an_interrupted_table_says_how_far_it_is() {
    let bench = bench();
    let loads = |table: &str, loads: &str| {
        let command = if table == "c.csv" { "cycle --steps 3" } else { "sweep" };
        bench.said(&format!("{command} --heights heights.npy {LAW} --mean-gaps {loads} --force --quiet --out {table}"));
        page(&bench, table, &format!("{table}.html"))
    };
    // a withdrawal in which the surfaces come apart ends before its last load
    let cycles = ["0.04,0.03,0.04", "0.04,0.03,0.3"].map(|all| ("c.csv", all, "it ends on leg 1 of 2"));
    for (table, all, told) in [("s.csv", "0.04:0.03:4", "it has 2 of 4 rows")].into_iter().chain(cycles) {
        assert!(!loads(table, all).contains("not complete"), "{table}");
        // as a kill leaves it
        let rows = bench.read(table);
        bench.write(table, &rows.split_inclusive('\n').take(3).collect::<String>());
        let page = page(&bench, table, &format!("{table}.html"));
        assert!(
            page.contains(&format!("The table is not complete, {told}: asperity run {table}.scene.toml continues it.")),
            "{page:.3000}"
        );
    }
    // forces are held by mean pressures, which differ from them on an area that is not one
    let forces = "--lengths 2 2 --normal-forces 0.01,0.02";
    bench.said(&format!("cycle --steps 3 --heights heights.npy {forces} --force --quiet --out c.csv"));
    assert!(!page(&bench, "c.csv", "c.csv.html").contains("not complete"));
}

#[test]
fn a_solve_without_a_folder_prints_its_result() {
    let bench = bench();
    let solve = "solve --heights heights.npy --mean-pressure 0.01";
    let names = bench.names(".");
    let said = bench.said(solve);
    assert!(said.contains("mean pressure") && !said.contains("results in"), "{said}");
    assert_eq!(bench.names("."), names);
    let found = bench.reported(solve);
    bench.said(&format!("{solve} --quiet --out results"));
    assert_eq!(found["contact_nodes"], bench.report("results")["contact_nodes"]);
    let looks = ["--format vti", "--picture-format svg", "--dpi 300", "--colour-limits 0 1", "--colour-clusters"];
    for files in ["--fields displacement", "--distribution"].into_iter().chain(looks) {
        bench.refused_with(&format!("{solve} {files}"), &["--out"]);
    }
    for command in ["contact", "leak"] {
        bench.refused_with(&format!("{command} results --dpi 300"), &["--out"]);
    }
}

#[test]
fn theories_stand_next_to_a_sweep() {
    let bench = bench();
    let sweep = "sweep --heights heights.npy --quiet --force --out area.csv --plot area.svg --theory";
    bench.said(&format!("{sweep} --mean-pressures 1e-3:1e-1:4:log"));
    let chart = bench.read("area.svg");
    let names = [">counted<", ">corrected for the edge<", ">Persson<", ">Greenwood and Williamson, for light loads<"];
    assert!(names.iter().all(|name| chart.contains(name)), "{chart}");
    bench.said(&format!("{sweep} --mean-gaps 0.03,0.02"));
    let chart = bench.read("area.svg");
    assert!(chart.contains(">Persson<") && chart.contains(">solves<") && !chart.contains("Greenwood"));
    for (more, told) in [(LAW, "--law"), ("--hardness 0.1", "a hardness"), ("--boundary free", "--boundary free")] {
        let load = "--mean-pressures 0.01";
        bench.refused_with(&format!("{sweep} {load} {more}"), &["--theory", told, "leave --theory out"]);
    }
    bench.refused_with("sweep --heights heights.npy --mean-gaps 0.02 --out b.csv --theory", &["--plot"]);
}
