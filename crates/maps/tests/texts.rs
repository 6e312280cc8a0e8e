//! Texts of points and of few columns, in all orders, separators and commas.

use asperity_maps::io::Reading;
use asperity_maps::warning::Warning;
use ndarray::Array2;

/// A table as a text, with a comment or a heading on top.
fn written(heading: &str, rows: &[Vec<f64>], separator: &str, decimal: &str, sign: &str) -> String {
    let number = |value: &f64| value.to_string().replace('.', decimal).replace('-', sign);
    let line = |row: &Vec<f64>| row.iter().map(number).collect::<Vec<_>>().join(separator);
    let lines = rows.iter().map(line).collect::<Vec<_>>().join("\n");
    if heading.is_empty() { lines } else { format!("{heading}\n{lines}") }
}

/// Counts texts of points, in all orders of their columns, and texts of few columns, by all separators and commas, that
/// are read right and refused; there are no others, but for a warning.
#[test]
fn no_variant_of_a_text_is_read_wrong_in_silence() {
    let height = |i: usize, j: usize| ((7 * i * i + 3 * j * i + j) % 11) as f64 - 4.5;
    let right = Array2::from_shape_fn((8, 6), |(i, j)| height(i, j));
    let order = |k: usize| (k * 17 + 5) % 48;
    let (mut read, mut refused, mut warned) = (0, 0, 0);
    let mut check = |name: &str, text: String, right: &Array2<f64>, sides: Option<(f64, f64)>| match Reading::default()
        .read_bytes(name, text.as_bytes())
    {
        Err(_) => refused += 1,
        Ok(map) if map.heights == *right && map.lengths == sides => read += 1,
        Ok(map) => {
            assert!(!Warning::of_topography(&map).is_empty(), "{text}");
            warned += 1;
        }
    };
    let names = ["x y z", "z x y", "x z y", "y x z", "z y x", "y z x", "x y z q", "q x y z", "i x y z", "z i q y x"];
    for columns in names {
        let columns: Vec<_> = columns.split(' ').collect();
        let row = |k: usize, i: usize, j: usize| {
            let of = |name: &&str| match *name {
                "x" => 0.5 * i as f64,
                "y" => 0.25 * j as f64,
                "z" => height(i, j),
                "q" => 1.5,
                _ => k as f64,
            };
            columns.iter().map(of).collect::<Vec<_>>()
        };
        for is_shuffled in [false, true] {
            let place = |k: usize| if is_shuffled { order(k) } else { k };
            let rows: Vec<_> = (0..48).map(|k| row(k, place(k) / 6, place(k) % 6)).collect();
            for separator in [" ", "\t", ",", ";", ", ", "  "] {
                let with_units = columns.iter().map(|name| format!("{name} [um]")).collect::<Vec<_>>();
                let by = |columns: &[String]| columns.join(separator);
                let plain = columns.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
                for heading in [
                    String::new(),
                    format!("# {}", by(&plain)),
                    by(&plain).to_uppercase(),
                    format!("# columns: {}", by(&plain)),
                    format!("% {}", plain.join(" ")),
                    format!("# {}", by(&with_units)),
                    by(&with_units),
                    format!("{}\n{}", by(&plain), by(&columns.iter().map(|_| "um".to_owned()).collect::<Vec<_>>())),
                ] {
                    for name in ["a.txt", "a.xyz"] {
                        let (map, sides) = if heading.ends_with("um") || heading.contains("[um]") {
                            (right.mapv(|h| h / 1e6), (4.0 / 1e6, 1.5 / 1e6))
                        } else {
                            (right.clone(), (4.0, 1.5))
                        };
                        // the order of x and y is told by names alone
                        let first = columns.iter().find(|name| "xy".contains(**name));
                        if heading.is_empty() && first == Some(&"y") {
                            continue;
                        }
                        check(name, written(&heading, &rows, separator, ".", "-"), &map, Some(sides));
                    }
                }
            }
        }
    }
    for columns in [1, 2, 3, 4] {
        let values = |i: usize| (0..columns).map(|j| height(i, j) + 0.25).collect::<Vec<_>>();
        let rows: Vec<_> = (0..12).map(values).collect();
        let right = Array2::from_shape_fn((12, columns), |(i, j)| rows[i][j]);
        for separator in [" ", "\t", ";", "; ", ",", ", "] {
            for decimal in [".", ","] {
                for sign in ["-", "\u{2212}"] {
                    for heading in ["", "# z", "# heights", "Z"] {
                        let text = written(heading, &rows, separator, decimal, sign);
                        for text in [
                            text.clone(),
                            text.replace('\n', "\r\n"),
                            format!("{text}\n\n"),
                            text.replace("5\n", "5E2\n"),
                        ] {
                            let is_scaled = text.contains("5E2");
                            let scaled = Array2::from_shape_fn(right.dim(), |(i, j)| {
                                right[[i, j]] * if is_scaled && j + 1 == columns && i < 11 { 100.0 } else { 1.0 }
                            });
                            check("a.txt", text, &scaled, None);
                        }
                    }
                }
            }
        }
    }
    assert!(read > 2000 && refused < 1200 && warned == 0, "{read} read, {refused} refused, {warned} warned");
}

/// Tables of decimal commas between commas are refused, whatever their numbers; tables of many whole numbers are read.
#[test]
fn decimal_commas_between_commas_are_refused_and_whole_numbers_are_read() {
    let read = |text: &str| Reading::default().read_bytes("a.txt", text.as_bytes());
    let table = |rows: usize, columns: usize, number: &dyn Fn(f64) -> String| {
        // rough, with all digits
        let height = |k: usize| number(((k * k * 7 + k * 13) % 997) as f64 / 997.0);
        let row = |i: usize| (0..columns).map(|j| height(i * columns + j)).collect::<Vec<_>>().join(",");
        (0..rows).map(row).collect::<Vec<_>>().join("\n")
    };
    for (rows, columns) in [(1, 2), (2, 2), (3, 4), (12, 3), (12, 8), (40, 40), (64, 33)] {
        for digits in 1..=6 {
            for (scale, least) in [(1.0, 0.0), (8.0, -4.0), (1000.0, 0.0), (300.0, 500.0), (0.7, 12.0), (2.5, 12.2)] {
                let text =
                    table(rows, columns, &|share| format!("{:.digits$}", scale * share + least).replace('.', ","));
                assert!(read(&text).is_err(), "{text}");
                let shortest = table(rows, columns, &|share| {
                    let number = (scale * share + least) * 10_f64.powi(digits as i32);
                    let text = (number.round() / 10_f64.powi(digits as i32)).to_string();
                    if text.contains('.') { text.replace('.', ",") } else { text + ",0" }
                });
                assert!(read(&shortest).is_err(), "{shortest}");
            }
        }
    }
    for columns in [2, 3, 4, 5, 8, 33, 64] {
        for most in [255.0, 4095.0, 65535.0] {
            let text = table(64, columns, &|share| (most * share).round().to_string());
            let is_asked = columns == 2;
            assert_eq!(read(&text).map(|map| map.heights.dim()).ok(), (!is_asked).then_some((64, columns)), "{text}");
        }
    }
}
