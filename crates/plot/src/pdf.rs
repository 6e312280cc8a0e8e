//! Pictures as PDF: text in the embedded font, so that it can be searched, and maps as images.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::Picture;
use crate::font;
use crate::png;
use crate::shape::{Colour, Shape};
use crate::svg::number;

/// The numbers of the objects; images come after them.
const CATALOGUE: usize = 1;
const PAGES: usize = 2;
const PAGE: usize = 3;
const CONTENT: usize = 4;
const INFO: usize = 5;
const FONT: usize = 6;
const GLYPHS: usize = 7;
const DESCRIPTOR: usize = 8;
const FONT_FILE: usize = 9;
const UNICODE: usize = 10;
const FIRST_IMAGE: usize = 11;

/// The bytes of a PDF file of one page.
pub(super) fn encode(picture: &Picture) -> std::io::Result<Vec<u8>> {
    let (content, images, characters) = content(picture)?;
    let image_names: String = (0..images.len()).map(|k| format!("/I{k} {} 0 R ", FIRST_IMAGE + k)).collect();
    let (width, height) = (number(picture.width), number(picture.height));
    let mut file = File::new();
    file.object(CATALOGUE, &format!("<</Type/Catalog/Pages {PAGES} 0 R>>"));
    file.object(PAGES, &format!("<</Type/Pages/Kids[{PAGE} 0 R]/Count 1>>"));
    file.object(
        PAGE,
        &format!(
            "<</Type/Page/Parent {PAGES} 0 R/MediaBox[0 0 {width} {height}]/Contents {CONTENT} 0 R\
             /Resources<</Font<</F {FONT} 0 R>>/XObject<<{image_names}>>>>>>"
        ),
    );
    file.stream(CONTENT, "", content.as_bytes());
    let title: String = picture.title.encode_utf16().map(|unit| format!("{unit:04X}")).collect();
    file.object(INFO, &format!("<</Title<FEFF{title}>/Producer(asperity {})>>", env!("CARGO_PKG_VERSION")));
    write_font(&mut file, &characters);
    for (k, (dictionary, data)) in images.iter().enumerate() {
        file.stream(FIRST_IMAGE + k, dictionary, data);
    }
    Ok(file.finish())
}

/// The operators that draw the page, its images, and the characters of each glyph on it.
type Content = (String, Vec<(String, Vec<u8>)>, BTreeMap<u16, char>);

fn content(picture: &Picture) -> std::io::Result<Content> {
    // y runs downwards, as in the shapes
    let mut content = format!("1 0 0 -1 0 {} cm\n", number(picture.height));
    let (mut images, mut characters) = (Vec::new(), BTreeMap::new());
    for shape in &picture.shapes {
        let _ = match shape {
            Shape::Fill(area, fill) => {
                let [x, y, w, h] = [area.left, area.top, area.width, area.height].map(number);
                writeln!(content, "{} rg {x} {y} {w} {h} re f", rgb(*fill))
            }
            Shape::Triangle(corners, fill) => writeln!(content, "{} rg {}h f", rgb(*fill), path(corners)),
            Shape::Curve(curve) => {
                let [x, y, w, h] =
                    [curve.within.left, curve.within.top, curve.within.width, curve.within.height].map(number);
                let pieces: String = curve.pieces.iter().map(|piece| path(piece)).collect();
                let (colour, width) = (rgb(curve.colour), number(curve.width));
                writeln!(content, "q {x} {y} {w} {h} re W n {colour} RG {width} w 1 J 1 j {pieces}S Q")
            }
            Shape::Text(text) => {
                let back = text.anchor.before() * font::width(&text.text, text.size);
                let (x, y) = text.at;
                let place = if text.upwards {
                    format!("0 -1 -1 0 {} {}", number(x), number(y + back))
                } else {
                    format!("1 0 0 -1 {} {}", number(x - back), number(y))
                };
                let mut glyphs = String::new();
                for character in text.text.chars() {
                    let glyph = font::glyph(character).0;
                    characters.entry(glyph).or_insert(character);
                    let _ = write!(glyphs, "{glyph:04X}");
                }
                writeln!(content, "BT 0 g /F {} Tf {place} Tm <{glyphs}> Tj ET", number(text.size))
            }
            Shape::Image(image) => {
                let (columns, rows) = (image.columns, image.rows());
                let data = png::compressed(&png::encode(columns, &image.pixels, picture.dpi)?);
                let dictionary = format!(
                    "/Type/XObject/Subtype/Image/Width {columns}/Height {rows}/ColorSpace/DeviceRGB/BitsPerComponent 8\
                     /Filter/FlateDecode/DecodeParms<</Predictor 15/Colors 3/BitsPerComponent 8/Columns {columns}>>"
                );
                let [x, y, w, h] =
                    [image.area.left, image.area.bottom(), image.area.width, image.area.height].map(number);
                let drawn = writeln!(content, "q {w} 0 0 -{h} {x} {y} cm /I{} Do Q", images.len());
                images.push((dictionary, data));
                drawn
            }
        };
    }
    Ok((content, images, characters))
}

/// The font, whole, with the widths of its glyphs, and the characters that a search finds in them.
fn write_font(file: &mut File, characters: &BTreeMap<u16, char>) {
    let Some(face) = font::face() else { return };
    let thousandths = |units: i16| 1000 * i32::from(units) / i32::from(face.units_per_em());
    let bounds = face.global_bounding_box();
    let [left, low, right, high] = [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(thousandths);
    let (ascent, descent) = (thousandths(face.ascender()), thousandths(face.descender()));
    let capitals = thousandths(face.capital_height().unwrap_or_default());
    let widths = (0..face.number_of_glyphs()).map(|glyph| 1000.0 * font::advance(ttf_parser::GlyphId(glyph)));
    let widths: Vec<_> = widths.map(|width| format!("{width:.0}")).collect();
    file.object(
        FONT,
        &format!(
            "<</Type/Font/Subtype/Type0/BaseFont/Arimo/Encoding/Identity-H/DescendantFonts[{GLYPHS} 0 R]\
             /ToUnicode {UNICODE} 0 R>>"
        ),
    );
    file.object(
        GLYPHS,
        &format!(
            "<</Type/Font/Subtype/CIDFontType2/BaseFont/Arimo/CIDToGIDMap/Identity\
             /CIDSystemInfo<</Registry(Adobe)/Ordering(Identity)/Supplement 0>>/FontDescriptor {DESCRIPTOR} 0 R\
             /W[0[{}]]>>",
            widths.join(" ")
        ),
    );
    file.object(
        DESCRIPTOR,
        &format!(
            "<</Type/FontDescriptor/FontName/Arimo/Flags 4/FontBBox[{left} {low} {right} {high}]/ItalicAngle 0\
             /Ascent {ascent}/Descent {descent}/CapHeight {capitals}/StemV 80/FontFile2 {FONT_FILE} 0 R>>"
        ),
    );
    file.stream(FONT_FILE, &format!("/Length1 {}", font::FILE.len()), font::FILE);
    let mut map = "/CIDInit/ProcSet findresource begin 12 dict begin begincmap\n\
                   /CIDSystemInfo<</Registry(Adobe)/Ordering(UCS)/Supplement 0>>def\n\
                   /CMapName/Adobe-Identity-UCS def/CMapType 2 def\n\
                   1 begincodespacerange<0000><FFFF>endcodespacerange\n"
        .to_owned();
    let entries: Vec<_> = characters.iter().collect();
    // at most 100 entries go together
    for some in entries.chunks(100) {
        let _ = writeln!(map, "{} beginbfchar", some.len());
        for (glyph, character) in some {
            let mut units = [0; 2];
            let units: String = character.encode_utf16(&mut units).iter().map(|unit| format!("{unit:04X}")).collect();
            let _ = writeln!(map, "<{glyph:04X}><{units}>");
        }
        map.push_str("endbfchar\n");
    }
    map.push_str("endcmap CMapName currentdict/CMap defineresource pop end end\n");
    file.stream(UNICODE, "", map.as_bytes());
}

/// A file as it grows, with the places of its objects.
struct File {
    bytes: Vec<u8>,
    objects: BTreeMap<usize, usize>,
}

impl File {
    fn new() -> Self {
        // bytes beyond ASCII say that the file is binary
        Self { bytes: b"%PDF-1.5\n%\xe2\xe3\xcf\xd3\n".to_vec(), objects: BTreeMap::new() }
    }

    fn begin(&mut self, object: usize) {
        self.objects.insert(object, self.bytes.len());
        self.bytes.extend_from_slice(format!("{object} 0 obj\n").as_bytes());
    }

    fn object(&mut self, object: usize, content: &str) {
        self.begin(object);
        self.bytes.extend_from_slice(content.as_bytes());
        self.bytes.extend_from_slice(b"\nendobj\n");
    }

    fn stream(&mut self, object: usize, dictionary: &str, data: &[u8]) {
        self.begin(object);
        self.bytes.extend_from_slice(format!("<<{dictionary}/Length {}>>stream\n", data.len()).as_bytes());
        self.bytes.extend_from_slice(data);
        self.bytes.extend_from_slice(b"\nendstream\nendobj\n");
    }

    /// The file with the table of its objects; none is missing.
    fn finish(mut self) -> Vec<u8> {
        let (table, size) = (self.bytes.len(), self.objects.len() + 1);
        let mut end = format!("xref\n0 {size}\n0000000000 65535 f \n");
        for place in self.objects.values() {
            let _ = writeln!(end, "{place:010} 00000 n ");
        }
        let _ =
            write!(end, "trailer\n<</Size {size}/Root {CATALOGUE} 0 R/Info {INFO} 0 R>>\nstartxref\n{table}\n%%EOF\n");
        self.bytes.extend_from_slice(end.as_bytes());
        self.bytes
    }
}

fn rgb(colour: Colour) -> String {
    let [red, green, blue] = colour.map(|part| format!("{:.4}", f64::from(part) / 255.0));
    format!("{red} {green} {blue}")
}

/// The way through points; through a single one, a line of no length.
fn path(points: &[(f64, f64)]) -> String {
    let mut path = String::new();
    let again = if points.len() == 1 { points } else { &[] };
    for (k, (x, y)) in points.iter().chain(again).enumerate() {
        let _ = write!(path, "{} {} {} ", number(*x), number(*y), if k == 0 { 'm' } else { 'l' });
    }
    path
}
