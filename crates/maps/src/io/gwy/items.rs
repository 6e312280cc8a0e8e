//! The items of a Gwyddion file: name, letter of the type, value.

use super::super::{DAMAGED, Parsed, TRUNCATED, refuse};

/// The value of an item; only what height maps have is told apart.
pub(super) enum Value<'a> {
    Whole(i32),
    Number(f64),
    Text(&'a [u8]),
    Numbers(&'a [[u8; 8]]),
    /// by its type and its items
    Object(&'a [u8], &'a [u8]),
    Other,
}

/// The items that are still to be read.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Parsed<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(TRUNCATED)?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Parsed<[u8; N]> {
        self.take(N)?.try_into().map_err(|_| DAMAGED.into())
    }

    /// A text that ends with a zero.
    fn text(&mut self) -> Parsed<&'a [u8]> {
        let end = self.0.iter().position(|byte| *byte == 0).ok_or(TRUNCATED)?;
        let taken = self.take(end)?;
        self.take(1)?;
        Ok(taken)
    }

    fn size(&mut self) -> Parsed<usize> {
        usize::try_from(u32::from_le_bytes(self.array()?)).map_err(|_| DAMAGED.into())
    }

    /// The type of an object, and its items.
    pub(super) fn object(&mut self) -> Parsed<(&'a [u8], &'a [u8])> {
        let (kind, size) = (self.text()?, self.size()?);
        Ok((kind, self.take(size)?))
    }

    fn item(&mut self) -> Parsed<(&'a [u8], Value<'a>)> {
        let name = self.text()?;
        let [kind] = self.array()?;
        let value = match kind {
            b'i' => Value::Whole(i32::from_le_bytes(self.array()?)),
            b'd' => Value::Number(f64::from_le_bytes(self.array()?)),
            b's' => Value::Text(self.text()?),
            b'o' => {
                let (kind, items) = self.object()?;
                Value::Object(kind, items)
            }
            b'D' => {
                let count = self.size()?;
                Value::Numbers(self.take(count.checked_mul(8).ok_or(TRUNCATED)?)?.as_chunks().0)
            }
            b'b' | b'c' => self.skip(1)?,
            b'q' => self.skip(8)?,
            b'C' | b'I' | b'Q' => {
                let width = if kind == b'C' {
                    1
                } else if kind == b'I' {
                    4
                } else {
                    8
                };
                let count = self.size()?;
                self.skip(count.checked_mul(width).ok_or(TRUNCATED)?)?
            }
            b'S' => {
                for _ in 0..self.size()? {
                    self.text()?;
                }
                Value::Other
            }
            b'O' => {
                for _ in 0..self.size()? {
                    self.object()?;
                }
                Value::Other
            }
            _ => return refuse(DAMAGED),
        };
        Ok((name, value))
    }

    fn skip(&mut self, count: usize) -> Parsed<Value<'a>> {
        self.take(count).map(|_| Value::Other)
    }
}

/// Its items, up to the first that cannot be read.
impl<'a> Iterator for Bytes<'a> {
    type Item = Parsed<(&'a [u8], Value<'a>)>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.0.is_empty() {
            return None;
        }
        let item = self.item();
        if item.is_err() {
            self.0 = &[];
        }
        Some(item)
    }
}
