//! How a file is read, where its format leaves a choice.

use std::io::Cursor;
use std::path::Path;

use asperity::Result;

use super::{ending, read_any, read_from};
use crate::Topography;

/// How a file is read, where its format leaves a choice; by default as [`read_topography`](super::read_topography) reads
/// it.
///
/// ```
/// use asperity_maps::io::Reading;
/// let mut reading = Reading::default();
/// (reading.skip_lines, reading.missing) = (1, vec!["lost".into()]);
/// let map = reading.read_bytes("heights.txt", b"my heights\n1 2 3\n4 lost 6\n")?;
/// assert_eq!((map.heights.dim(), map.missing()), ((2, 3), 1));
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// The channel, by its number or its title, of a `.gwy` file or of a text with several blocks of numbers.
    pub channel: Option<String>,
    /// The number of lines at the start of a text that are left out.
    pub skip_lines: usize,
    /// Words of a text that stand for missing points, besides those that are known.
    pub missing: Vec<String>,
    /// Whether the points under the mask of a `.gwy` file are missing.
    pub masked: bool,
}

impl Reading {
    /// Reads a height map from a file.
    ///
    /// # Errors
    ///
    /// As for [`read_topography`](super::read_topography), and [`Error::File`](asperity::Error::File) if the file has no
    /// such channel, or is of a format that leaves no such choice.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<Topography> {
        let path = path.as_ref();
        read_any(path, self).map_err(|refusal| refusal.in_file(path))
    }

    /// Reads a height map from the bytes of a file of a name, where there are no files, as in a browser.
    ///
    /// # Errors
    ///
    /// As for [`read`](Self::read), with the name in the place of the path.
    pub fn read_bytes(&self, name: &str, bytes: &[u8]) -> Result<Topography> {
        let path = Path::new(name);
        read_from(Cursor::new(bytes), bytes.len() as u64, &ending(path), self).map_err(|refusal| refusal.in_file(path))
    }
}
