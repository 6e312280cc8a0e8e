//! Height maps in Gwyddion's own files (`.gwy`).

mod items;

use std::collections::BTreeMap;
use std::io::Read;

use ndarray::{Array2, Zip};

use self::items::{Bytes, Value};
use super::channels::{Channel, chosen, others};
use super::units::{in_one_unit, is_length};
use super::{DAMAGED, Parsed, Reading, quoted, refuse, reserve, unreadable};
use crate::Topography;

pub(super) const GWY: &[u8] = b"GWYP";

/// Reads a channel of a Gwyddion file of `size` bytes, by its number or title; without one, the only channel, or the
/// only one of heights.
///
/// Behind four letters there is one object, and in objects there are items: name, letter of the type, value. Objects
/// and arrays have their size before them, so that others are skipped unread.
pub(super) fn read_gwy(reader: &mut impl Read, size: u64, reading: &Reading) -> Parsed<Topography> {
    let mut bytes = Vec::new();
    reserve(&mut bytes, usize::try_from(size).unwrap_or(usize::MAX))?;
    reader.take(size).read_to_end(&mut bytes).map_err(unreadable)?;
    let channels = channels(&bytes)?;
    let place = chosen(&channels, reading.channel.as_deref())?;
    let fields = fields(&bytes)?;
    let Titled { field: Some(field), mask, .. } = &fields[&channels[place].number] else { return refuse(DAMAGED) };
    let mut map = Field::new(field)?.map()?;
    map.unread = others(&channels, place);
    let mask = mask.map(|mask| Field::new(mask)?.upright()).transpose()?.filter(|mask| mask.dim() == map.heights.dim());
    let count = mask.iter().flatten().filter(|on| **on > 0.0).count();
    match mask {
        Some(mask) if reading.masked => Zip::from(&mut map.heights).and(&mask).for_each(|h, on| {
            if *on > 0.0 {
                *h = f64::NAN;
            }
        }),
        _ if reading.masked => {
            return refuse("has no mask over this channel: leave out that masked points are missing");
        }
        _ if count > 0 => map.unread.push(format!("a mask over {count} points, which --masked treats as missing")),
        _ => {}
    }
    Ok(map)
}

/// The channels of a file of heights by their numbers.
fn fields(bytes: &[u8]) -> Parsed<BTreeMap<usize, Titled<'_>>> {
    let mut start = Bytes(bytes.get(GWY.len()..).unwrap_or_default());
    let (kind, container) = start.object()?;
    if kind != b"GwyContainer" {
        return refuse(format!("holds a {}, expected a GwyContainer: save it again", quoted(&text(kind))));
    }

    let mut channels = BTreeMap::<usize, Titled<'_>>::new();
    for item in Bytes(container) {
        let (name, value) = item?;
        // as /0/data and /0/data/title; deeper or other names say how the channel is shown
        let name = text(name);
        let Some((number, what)) = name.strip_prefix('/').and_then(|rest| rest.split_once('/')) else { continue };
        let Ok(number) = number.parse() else { continue };
        match (what, value) {
            ("data", Value::Object(b"GwyDataField", field)) => channels.entry(number).or_default().field = Some(field),
            ("mask", Value::Object(b"GwyDataField", field)) => channels.entry(number).or_default().mask = Some(field),
            ("data/title", Value::Text(title)) => channels.entry(number).or_default().title = text(title),
            _ => {}
        }
    }
    channels.retain(|_, channel| channel.field.is_some());
    Ok(channels)
}

/// The channels of a Gwyddion file.
pub(super) fn channels(bytes: &[u8]) -> Parsed<Vec<Channel>> {
    let named = |(number, channel): (usize, Titled<'_>)| Channel {
        number,
        is_of_heights: channel.is_of_heights(),
        title: channel.title,
    };
    Ok(fields(bytes)?.into_iter().map(named).collect())
}

/// A channel: its title, its field, and the mask over it.
#[derive(Default)]
struct Titled<'a> {
    title: String,
    field: Option<&'a [u8]>,
    mask: Option<&'a [u8]>,
}

impl Titled<'_> {
    /// Whether heights and sides both are in units of length.
    fn is_of_heights(&self) -> bool {
        let field = self.field.and_then(|field| Field::new(field).ok());
        field.is_some_and(|field| is_length(&field.lateral) && is_length(&field.vertical))
    }
}

/// A GwyDataField.
#[derive(Default)]
struct Field<'a> {
    nodes: (i32, i32),
    lengths: (f64, f64),
    lateral: String,
    vertical: String,
    data: &'a [[u8; 8]],
}

impl<'a> Field<'a> {
    fn new(bytes: &'a [u8]) -> Parsed<Self> {
        // a side length that is left out is 1
        let mut field = Self { lengths: (1.0, 1.0), ..Self::default() };
        for item in Bytes(bytes) {
            match item? {
                (b"xres", Value::Whole(n)) => field.nodes.0 = n,
                (b"yres", Value::Whole(n)) => field.nodes.1 = n,
                (b"xreal", Value::Number(length)) => field.lengths.0 = length,
                (b"yreal", Value::Number(length)) => field.lengths.1 = length,
                (b"si_unit_xy", Value::Object(_, unit)) => field.lateral = unit_of(unit)?,
                (b"si_unit_z", Value::Object(_, unit)) => field.vertical = unit_of(unit)?,
                (b"data", Value::Numbers(data)) => field.data = data,
                _ => {}
            }
        }
        Ok(field)
    }

    fn map(&self) -> Parsed<Topography> {
        in_one_unit(self.upright()?, Some(self.lengths), &self.lateral, &self.vertical)
    }

    /// The values, with y upwards.
    fn upright(&self) -> Parsed<Array2<f64>> {
        let ((nx, ny), found) = (self.nodes, self.data.len());
        let shape = usize::try_from(nx).ok().zip(usize::try_from(ny).ok()).filter(|(nx, ny)| *nx > 0 && *ny > 0);
        let Some((nx, ny)) = shape.filter(|(nx, ny)| nx.checked_mul(*ny) == Some(found)) else {
            return refuse(format!("promises {nx} x {ny} heights but has {found}: it is damaged, save it again"));
        };
        let mut values = Vec::new();
        reserve(&mut values, found)?;
        // line by line from the top: the last one has y = 0
        let lines = || self.data.chunks_exact(nx).rev();
        values.extend((0..nx).flat_map(|i| lines().map(move |line| f64::from_le_bytes(line[i]))));
        Ok(Array2::from_shape_vec((nx, ny), values).map_err(|e| e.to_string())?)
    }
}

/// The text of a GwySIUnit.
fn unit_of(bytes: &[u8]) -> Parsed<String> {
    for item in Bytes(bytes) {
        if let (b"unitstr", Value::Text(unit)) = item? {
            return Ok(text(unit));
        }
    }
    Ok(String::new())
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::super::tests::{assert_refused, read, read_map};
    use super::*;

    fn object(kind: &str, items: &[Vec<u8>]) -> Vec<u8> {
        let items = items.concat();
        [kind.as_bytes(), b"\0", &(items.len() as u32).to_le_bytes(), &items].concat()
    }

    fn item(name: &str, kind: u8, value: &[u8]) -> Vec<u8> {
        [name.as_bytes(), &[0, kind], value].concat()
    }

    fn unit(name: &str, unit: &str) -> Vec<u8> {
        item(name, b'o', &object("GwySIUnit", &[item("unitstr", b's', &[unit.as_bytes(), b"\0"].concat())]))
    }

    /// Three by two heights, the upper line first.
    fn field(vertical: &str) -> Vec<Vec<u8>> {
        let data = [1.0, 2.0, 3.0, 4.0, f64::NAN, 6.0_f64];
        vec![
            item("xres", b'i', &3_i32.to_le_bytes()),
            item("yres", b'i', &2_i32.to_le_bytes()),
            item("xreal", b'd', &6.0_f64.to_le_bytes()),
            item("yreal", b'd', &2.0_f64.to_le_bytes()),
            unit("si_unit_xy", "µm"),
            unit("si_unit_z", vertical),
            item("data", b'D', &[&6_u32.to_le_bytes()[..], &data.map(f64::to_le_bytes).concat()].concat()),
        ]
    }

    fn gwy(items: &[Vec<u8>]) -> Vec<u8> {
        [GWY, &object("GwyContainer", items)].concat()
    }

    fn channel(number: usize, title: &str, field: &[Vec<u8>]) -> Vec<u8> {
        let title = item(&format!("/{number}/data/title"), b's', &[title.as_bytes(), b"\0"].concat());
        [title, item(&format!("/{number}/data"), b'o', &object("GwyDataField", field))].concat()
    }

    fn read_one(file: &[u8], name: &str) -> asperity::Result<Topography> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.gwy");
        std::fs::write(&path, file).unwrap();
        Reading { channel: Some(name.into()), ..Reading::default() }.read(&path)
    }

    #[test]
    fn a_channel_has_its_heights_upright_and_in_metres_among_items_of_every_type() {
        let nested = object("GwyStringList", &[item("strings", b'S', b"\x02\0\0\0one\0two\0")]);
        let others = [
            item("/0/data/visible", b'b', b"\x01"),
            item("/0/base/palette", b's', b"Gold\0"),
            item("/filename", b'c', b"x"),
            item("/0/q", b'q', &[0; 8]),
            item("/0/numbers", b'C', b"\x03\0\0\0abc"),
            item("/0/more", b'I', b"\x01\0\0\0abcd"),
            item("/0/most", b'Q', b"\x01\0\0\0abcdefgh"),
            item("/0/meta", b'o', &nested),
            item("/0/select", b'O', &[b"\x02\0\0\0", &nested[..], &nested].concat()),
            item("/0/mask", b'o', &object("GwyDataField", &field(""))),
        ];
        let map = read_map(gwy(&[&others[..], &[channel(0, "Height", &field("nm"))]].concat()), "a").unwrap();
        assert_eq!((map.heights.dim(), map.missing(), map.unit.as_deref()), ((3, 2), 1, Some("m")));
        assert_eq!(map.heights.column(1), array![1e-9, 2e-9, 3e-9]);
        assert_eq!((map.heights[[0, 0]], map.heights[[2, 0]]), (4e-9, 6e-9));
        assert_eq!(map.lengths, Some((6e-6, 2e-6)));
        // the mask is over five of six points, and NaN is in none
        assert_eq!(map.unread, ["a mask over 5 points, which --masked treats as missing"]);
        let file = gwy(&[&others[..], &[channel(0, "Height", &field("nm"))]].concat());
        let reading = Reading { masked: true, ..Reading::default() };
        assert_eq!(reading.read_bytes("map.gwy", &file).unwrap().missing(), 6);
        assert_refused(reading.read_bytes("map.gwy", &gwy(&[channel(0, "Height", &field("nm"))])), &["no mask"]);
        assert_refused(reading.read_bytes("map.txt", b"1 2\n3 4\n"), &["no masks", "leave"]);
    }

    #[test]
    fn one_of_several_channels_is_chosen_by_number_or_title() {
        let volts = channel(3, "Error", &field("V"));
        let file = gwy(&[channel(0, "Trace", &field("nm")), channel(1, "Retrace", &field("µm")), volts.clone()]);
        for (name, expected) in [("0", 1e-9), ("Trace", 1e-9), ("1", 1e-6), ("Retrace", 1e-6)] {
            assert_eq!(read_one(&file, name).unwrap().heights[[0, 1]], expected, "{name}");
        }
        assert_refused(read(&file), &["3 channels", "0 \"Trace\", 1 \"Retrace\"", "2 of them", "--channel"]);
        assert_refused(read_one(&file, "Phase"), &["\"Phase\"", "0 \"Trace\""]);
        assert_refused(read_one(&file, "3"), &["\"V\"", "channel of heights"]);
        // the only one of heights needs no name
        let map = read_map(gwy(&[volts.clone(), channel(7, "Height", &field("nm"))]), "a").unwrap();
        assert_eq!((map.heights[[0, 1]], &map.unread[..]), (1e-9, &["3 \"Error\"".to_owned()][..]));
        let same = gwy(&[channel(0, "Height", &field("nm")), channel(1, "Height", &field("nm"))]);
        assert_refused(read_one(&same, "Height"), &["several", "give a number"]);
        assert_refused(read(gwy(&[volts])), &["\"V\""]);
        assert_refused(read(gwy(&[])), &["no channel of heights"]);
        assert_refused(read_one(b"1 2\n3 4\n", "1"), &["1 channels (0 \"2 x 2 numbers\")", "but no \"1\""]);
    }

    #[test]
    fn channels_are_told_with_what_they_are_of() {
        let file = gwy(&[channel(0, "Trace", &field("nm")), channel(3, "Error", &field("V"))]);
        let told = super::super::channels("scan.gwy", &file).unwrap();
        let told: Vec<_> = told.iter().map(|found| (found.number, &found.title[..], found.is_of_heights)).collect();
        assert_eq!(told, [(0, "Trace", true), (3, "Error", false)]);
        assert_eq!(super::super::channels("map.txt", b"1 2\n").unwrap(), []);
        let read = Reading::default().read_bytes("scan.gwy", &file).unwrap();
        assert_eq!(read.heights.column(1), read_map(&file, "scan.gwy").unwrap().heights.column(1));
    }

    #[test]
    fn damaged_gwy_is_refused_without_panic() {
        let file = gwy(&[channel(0, "Height", &field("nm"))]);
        for length in 0..file.len() {
            assert!(read(&file[..length]).is_err(), "{length}");
        }
        let whole = |changed: &[Vec<u8>]| read(gwy(&[channel(0, "", changed)]));
        let with = |name: &str, kind: u8, value: &[u8]| whole(&[field("m"), vec![item(name, kind, value)]].concat());
        assert_refused(with("xres", b'i', &4_i32.to_le_bytes()), &["4 x 2 heights", "has 6"]);
        assert_refused(with("xres", b'i', &(-3_i32).to_le_bytes()), &["-3 x 2 heights"]);
        assert_refused(with("xreal", b'd', &f64::NAN.to_le_bytes()), &["side lengths of NaN", "positive"]);
        assert_refused(with("data", b'D', b"\xff\xff\xff\xff"), &["ends too early"]);
        assert_refused(with("data", b'S', b"\xff\xff\xff\xff"), &["ends too early"]);
        assert_refused(with("data", b'O', b"\xff\xff\xff\xff"), &["ends too early"]);
        assert_refused(with("data", b'?', b""), &["damaged"]);
        assert_refused(whole(&[]), &["0 x 0 heights"]);
        assert_refused(read([GWY, &object("GwyGraph", &[])].concat()), &["\"GwyGraph\"", "GwyContainer"]);
        assert_refused(read(gwy(&[item("/0/data", b'o', b"GwyDataField\0\xff\xff\xff\x7f")])), &["ends too early"]);
    }
}
