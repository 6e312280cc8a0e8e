//! Fields as VTK image data (`.vti`).

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use asperity::{Error, Grid, Real, Result};
use ndarray::ArrayView2;

use super::npy_writer::write_numbers;

/// Writes fields as VTK image data (`.vti`, for ParaView), over a file that may be there.
///
/// Point data in the precision of the fields, each with its name, at the nodes of the grid, with the grid's origin;
/// the last node of a side is a spacing short of its periodic image. Raw appended data, in the form of VTK 6 and
/// later.
///
/// ```
/// use asperity::Grid;
/// use asperity_maps::io::write_vti;
/// let folder = tempfile::tempdir()?;
/// let grid = Grid::new((4, 3), (2.0, 3.0))?;
/// write_vti(folder.path().join("fields.vti"), &grid, &[("height", grid.sample(|x, y| x * y).view())])?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`Error::Shape`] if a field does not fit the grid, [`Error::File`] if the file cannot be written.
pub fn write_vti<T: Real>(path: impl AsRef<Path>, grid: &Grid, fields: &[(&str, ArrayView2<'_, T>)]) -> Result<()> {
    let path = path.as_ref();
    fields.iter().try_for_each(|(_, field)| Error::shape("field", field.dim(), grid.shape()))?;
    write(path, grid, fields).map_err(|e| Error::unwritable(path, e))
}

fn write<T: Real>(path: &Path, grid: &Grid, fields: &[(&str, ArrayView2<'_, T>)]) -> io::Result<()> {
    let ((nx, ny), (dx, dy), (x, y)) = (grid.shape(), grid.spacing(), (grid.x(0), grid.y(0)));
    // on a line y is nothing's coordinate
    let (dy, y) = if grid.is_line() { (dx, 0.0) } else { (dy, y) };
    let extent = format!("0 {} 0 {} 0 0", nx - 1, ny - 1);
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "<?xml version=\"1.0\"?>")?;
    writeln!(file, r#"<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#)?;
    write!(file, r#"<ImageData WholeExtent="{extent}" Origin="{x:e} {y:e} 0" "#)?;
    writeln!(file, r#"Spacing="{dx:e} {dy:e} {:e}">"#, dx.min(dy))?;
    writeln!(file, r#"<Piece Extent="{extent}"><PointData>"#)?;
    let (width, vtk_type) = if T::NAME == "f32" { (4, "Float32") } else { (8, "Float64") };
    let bytes = (width * nx * ny) as u64;
    for (k, (name, _)) in fields.iter().enumerate() {
        let name = name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        let offset = k as u64 * (8 + bytes);
        writeln!(file, r#"<DataArray type="{vtk_type}" Name="{name}" format="appended" offset="{offset}"/>"#)?;
    }
    write!(file, "</PointData></Piece></ImageData>\n<AppendedData encoding=\"raw\">\n_")?;
    for (_, field) in fields {
        file.write_all(&bytes.to_le_bytes())?;
        // x runs fastest
        write_numbers(&mut file, field.t())?;
    }
    file.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
    file.into_inner().map_err(io::IntoInnerError::into_error).map(drop)
}
