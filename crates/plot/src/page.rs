//! The look and the scripts of pages: the files that a page loads, or has in itself.

/// The look of a page, with its figures, tables and warnings, in light and in dark.
pub const LOOK: &str = include_str!("page/look.css");

/// The module `quantity.js`: quantities as they are typed and read.
pub const QUANTITY: &str = include_str!("page/quantity.js");

/// The module `zoom.js`: the part of a map that is shown, and the bar of its scale. It imports `quantity.js`.
pub const ZOOM: &str = include_str!("page/zoom.js");

/// A text without characters that mean something in XML and HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
