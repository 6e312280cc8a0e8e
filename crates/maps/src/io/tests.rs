use ndarray::{ShapeBuilder, array};

use super::*;

pub(super) fn read(bytes: impl AsRef<[u8]>) -> Result<Array2<f64>> {
    read_map(bytes, "heights").map(|map| map.heights)
}

pub(super) fn read_map(bytes: impl AsRef<[u8]>, name: &str) -> Result<Topography> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read_topography(&path)
}

/// Why it was refused, after checking that the message names the file and is a single line.
pub(super) fn reason(result: Result<impl std::fmt::Debug>) -> String {
    let error = result.unwrap_err();
    assert_eq!(error.to_string().lines().count(), 1, "{error:?}");
    assert!(error.to_string().chars().all(|c| !c.is_control()), "{error:?}");
    match error {
        Error::File { reason, path, .. } if !path.as_os_str().is_empty() => reason,
        other => panic!("{other:?}"),
    }
}

#[track_caller]
pub(super) fn assert_refused(result: Result<impl std::fmt::Debug>, parts: &[&str]) {
    let reason = reason(result);
    for part in parts {
        assert!(reason.contains(part), "{part:?} not in {reason:?}");
    }
}

#[test]
fn what_is_no_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert_refused(read_field(folder.path()), &["is a folder"]);
    assert_refused(read_field(folder.path().join("missing.npy")), &["does not exist", "check the path"]);
    if cfg!(unix) {
        assert_refused(read_field(Path::new("/dev/zero")), &["not a regular file"]);
    }
}

#[test]
fn sides_that_become_nothing_or_infinite_are_refused() {
    let gsf = |side: &str| {
        let mut file =
            format!("Gwyddion Simple Field 1.0\nXRes=1\nYRes=1\nXReal={side}\nYReal=1\nXYUnits=pm\nZUnits=pm\n")
                .into_bytes();
        file.resize((file.len() / 4 + 1) * 4 + 4, 0);
        read_map(file, "map.gsf").map(|map| map.lengths)
    };
    assert_eq!(gsf("2").unwrap(), Some((2e-12, 1e-12)));
    for side in ["0", "-1", "inf", "nan", "1e-320"] {
        assert_refused(gsf(side), &["side lengths of", "positive"]);
    }
    let points = |far: &str| read_map(format!("0 0 1\n{far} 0 2\n0 1 3\n{far} 1 4\n"), "map.xyz");
    assert_eq!(points("2").unwrap().lengths, Some((4.0, 2.0)));
    assert_refused(points("1e308"), &["side lengths of inf", "positive"]);
}

#[test]
fn units_are_written_as_long_as_they_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.npz");
    let mut map = Topography::new(array![[1.0, 2.0]]);
    map.unit = Some("µ".repeat(LONGEST_UNIT));
    write_topography(&path, &map).unwrap();
    assert_eq!(read_topography(&path).unwrap(), map);
    map.unit = Some("µ".repeat(LONGEST_UNIT + 1));
    assert_refused(write_topography(&path, &map), &["a unit of 65 characters", "at most 64"]);
}

#[test]
fn written_npy_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("field.npy");
    let field = array![[1.5, f64::INFINITY], [-0.0, 2.0], [3.0, 4.0]];
    write_npy(&path, &field).unwrap();
    assert_eq!(read_field(&path).unwrap(), field);
    // as numpy.save writes it
    let header = format!("{:117}\n", "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }");
    assert!(fs::read(&path).unwrap().starts_with(&[b"\x93NUMPY\x01\x00\x76\x00", header.as_bytes()].concat()));
    write_npy(&path, &field.mapv(|v| v as f32)).unwrap();
    assert_eq!(read_field(&path).unwrap(), field);
    let fortran = Array2::from_shape_fn((2, 3).f(), |(i, j)| (3 * i + j) as f32);
    write_npy(&path, &fortran).unwrap();
    assert_eq!(read_field(&path).unwrap(), fortran.mapv(f64::from));
    assert_refused(write_npy(folder.path().join("missing/field.npy"), &field), &["cannot be written"]);
}
