//! Surfaces in files of Fourier coefficients.

use std::io::BufRead;
use std::path::Path;

use asperity::surface::FourierSeries;
use asperity::{Grid, Result, Surface};

use super::lines::{Line, for_each_line};
use super::refusal::{Parsed, Refusal, refuse, unreadable};
use super::{Reading, foreign, opened};

const COLUMNS: &str = "expected lines of four numbers: qX, qY, and the real and the imaginary part of h(q)";

const BINARY: &str =
    "is no text: give the coefficients as a text, or their columns to asperity.surface.fourier in Python";

/// Reads a surface on a grid from a text of Fourier coefficients, such as the file of the contact-mechanics challenge
/// (Müser et al., *Tribology Letters* 65:118, 2017); heights are in units of `unit`.
///
/// A line has the whole numbers qX and qY of periods along the sides, of either sign, and the real and the imaginary
/// part of the coefficient, separated by white space or by commas; `#` and `%` start a comment. Waves without a line
/// have none. The series is a [`FourierSeries`]: a half spectrum is enough, and coefficients are as FFTW's inverse
/// transform takes them.
///
/// ```
/// use asperity::Grid;
/// use asperity_maps::io::read_fourier;
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("surface.Fourier.ASCII.dat");
/// std::fs::write(&path, "# qX, qY, Re{h(q)}, Im{h(q)}\n3, -1, 0.5, 0\n")?;
/// let surface = read_fourier(&path, Grid::square(16, 1e-4)?, 1e-4)?;
/// assert!((surface.heights()[[0, 0]] - 1e-4).abs() < 1e-19);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`Error::File`](asperity::Error::File) with the number of the line if it does not have four numbers, or
/// [`FourierSeries::add`] refuses them, as waves that the grid does not hold, and two coefficients of one wave;
/// [`FourierSeries::surface`]'s if there are none; [`Error::Memory`](asperity::Error::Memory) if they take more than
/// there is.
pub fn read_fourier(path: impl AsRef<Path>, grid: Grid, unit: f64) -> Result<Surface> {
    let path = path.as_ref();
    let mut series = FourierSeries::new(grid)?;
    let mut read = || -> Parsed<Surface> {
        let (mut reader, _) = opened(path, "a text file of Fourier coefficients")?;
        let start = reader.fill_buf().map_err(unreadable)?;
        let binary = foreign::by_start(start).or_else(|| foreign::by_ending(start, "")).map(|_| BINARY);
        let mut count = 0;
        let each = |line: usize, found: Line<'_>| match found {
            Line::Empty(_) | Line::Comment(_) => Ok(()),
            Line::Heading(_, reason) | Line::Broken(_, reason) => refuse(format!("{reason}: {COLUMNS}")),
            Line::Row(row) => {
                let &[m, n, re, im] = row.values else {
                    return refuse(format!("line {line} has {} numbers, {COLUMNS}", row.values.len()));
                };
                count += 1;
                series.add((m, n), (re, im)).map_err(|error| Refusal::from(format!("line {line}: {error}")))
            }
        };
        let read = for_each_line(reader, &Reading::default(), each);
        read.map_err(|refusal| binary.map_or(refusal, Refusal::from))?;
        if count == 0 {
            return refuse(format!("holds no numbers: {COLUMNS}"));
        }
        series.surface(unit).map_err(|error| Refusal::from(format!("cannot be a surface: {error}")))
    };
    read().map_err(|refusal| refusal.in_file(path))
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;
    use std::fs;

    use asperity::{Amplitude, SelfAffine};

    use super::super::tests::assert_refused;
    use super::*;

    fn read(text: impl AsRef<[u8]>, shape: (usize, usize)) -> Result<Surface> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("surface.dat");
        fs::write(&path, text).unwrap();
        read_fourier(&path, Grid::new(shape, (1.0, 1.0))?, 1.0)
    }

    #[test]
    fn a_surface_comes_back_from_a_file_of_its_coefficients() {
        let grid = Grid::square(24, 1.0).unwrap();
        let rough = SelfAffine::default().k_l(1.0).k_s(6.0).amplitude(Amplitude::RmsSlope(1.0)).surface(grid).unwrap();
        let turn = |q: (i64, i64), (i, j): (usize, usize)| {
            -std::f64::consts::TAU * (q.0 * i as i64 + q.1 * j as i64) as f64 / 24.0
        };
        let mut text = "# half spectrum\n".to_owned();
        // as the file of the challenge: half of the waves, column 0 as a whole, and only what is not zero
        for (m, n) in (-6..=6).flat_map(|m| (0..=6).map(move |n| (m, n))).filter(|q| *q != (0, 0)) {
            let (re, im) = rough.heights().indexed_iter().fold((0.0, 0.0), |(re, im), (place, h)| {
                let (sine, cosine) = turn((m, n), place).sin_cos();
                (re + h * cosine / 576.0, im + h * sine / 576.0)
            });
            if re.hypot(im) > 1e-12 {
                writeln!(text, "{m}, {n}, {re:e}, {im:e}").unwrap();
            }
        }
        let found = read(text, (24, 24)).unwrap();
        for (h, expected) in found.heights().iter().zip(rough.heights()) {
            assert!((h - expected).abs() < 1e-14, "{h} {expected}");
        }
    }

    #[test]
    fn what_is_no_file_of_coefficients_is_refused_by_its_line() {
        let refused = |text: &str, parts: &[&str]| assert_refused(read(text, (16, 16)), parts);
        refused("# q\n1 0 1 0\n2 0 1\n", &["line 3 has 3 numbers", "qX, qY"]);
        refused("1 0 1 0 5\n", &["line 1 has 5 numbers"]);
        refused("1 0 one 0\n", &["line 1: \"one\" is not a number", "lines of four numbers"]);
        refused("1 0 1 0\n\n0.5 0 1 0\n", &["line 3", "number of waves along x is 0.5", "whole number"]);
        refused("1 -8 1 0\n", &["line 1", "number of waves along y is -8", "below half", "take more nodes"]);
        refused("3 2 1 1\n1 0 1 0\n3 2 1 1\n", &["line 3", "number of coefficients of the wave is 2"]);
        refused("3 2 1 1\n-3 -2 1 1\n", &["line 2", "complex conjugate", "leave one of the two out"]);
        refused("# nothing\n", &["holds no numbers", "qX, qY"]);
        refused("1 0 0 0\n", &["number of coefficients other than zero is 0"]);
        assert_refused(read(b"\x89HDF\r\n\x1a\n\0\0", (16, 16)), &["is no text", "as a text"]);
        assert_refused(read([0; 1000], (16, 16)), &["is no text"]);
    }
}
