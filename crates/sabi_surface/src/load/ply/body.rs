//! The elements after the header of a PLY file.

use super::header::{Element, Encoding, Kind};
use crate::load::error::{Fault, damaged};
use crate::load::numbers::number;
use crate::load::warnings::Warnings;
use sabi_cancel::Looking as _;

/// Value of a property.
pub(super) enum Value {
    Number(f64),
    List(Vec<f64>),
}

/// Bytes that have not been read yet.
pub(super) struct Body<'b> {
    encoding: Encoding,
    rest: &'b [u8],
    /// Warnings about numbers of a text.
    pub(super) warnings: Warnings,
}

impl<'b> Body<'b> {
    pub(super) fn new(encoding: Encoding, rest: &'b [u8]) -> Body<'b> {
        Body {
            encoding,
            rest,
            warnings: Warnings::default(),
        }
    }

    /// Returns a fault if the file is too short for the element's count.
    pub(super) fn check_room(&self, element: &Element) -> Result<(), Fault> {
        let least = |binary: usize| match self.encoding {
            // A digit and a space.
            Encoding::Text => 2,
            _ => binary,
        };
        let properties = element.properties.iter();
        let each: usize = properties
            .map(|property| least(property.list.unwrap_or(property.kind).bytes()))
            .sum();
        // The last number of a text needs no space after it.
        let needed = element.count.saturating_mul(each as u64);
        if needed > self.rest.len() as u64 + 1 {
            return damaged(format!(
                "it promises {} elements `{}` and is too short for them; it was cut off",
                element.count, element.name
            ));
        }
        Ok(())
    }

    /// Reads the properties of one element.
    pub(super) fn row(&mut self, element: &Element, row: &mut Vec<Value>) -> Result<(), Fault> {
        row.truncate(element.properties.len());
        for (place, property) in element.properties.iter().enumerate() {
            let value = match property.list {
                None => Value::Number(self.number(property.kind)?),
                Some(count) => {
                    let mut entries = match row.get_mut(place) {
                        Some(Value::List(entries)) => std::mem::take(entries),
                        _ => Vec::new(),
                    };
                    self.list(count, property.kind, &mut entries)?;
                    Value::List(entries)
                }
            };
            match row.get_mut(place) {
                Some(held) => *held = value,
                None => row.push(value),
            }
        }
        Ok(())
    }

    /// Skips the elements.
    pub(super) fn skip(&mut self, element: &Element) -> Result<(), Fault> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row = Vec::new();
        for _ in (0..element.count).looking() {
            self.row(element, &mut row)?;
        }
        Ok(())
    }

    fn list(&mut self, count: Kind, kind: Kind, entries: &mut Vec<f64>) -> Result<(), Fault> {
        let count = self.number(count)?;
        let most = match self.encoding {
            Encoding::Text => self.rest.len() / 2 + 1,
            _ => self.rest.len() / kind.bytes(),
        };
        if !(0.0..=most as f64).contains(&count) {
            return damaged(format!("a list of it promises {count} entries; it was cut off"));
        }
        entries.clear();
        for _ in (0..count as usize).looking() {
            entries.push(self.number(kind)?);
        }
        Ok(())
    }

    fn number(&mut self, kind: Kind) -> Result<f64, Fault> {
        match self.encoding {
            Encoding::Text => self.word(),
            Encoding::LittleEndian => self.binary(kind, |_| {}),
            Encoding::BigEndian => self.binary(kind, <[u8]>::reverse),
        }
    }

    fn word(&mut self) -> Result<f64, Fault> {
        let start = self.rest.trim_ascii_start();
        let end = start.iter().position(u8::is_ascii_whitespace).unwrap_or(start.len());
        let (word, rest) = start.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return damaged("it ends in the middle of its elements; it was cut off");
        }
        // A word that is not UTF-8 is not a number.
        let text = String::from_utf8_lossy(word);
        number(&text, &mut self.warnings).ok_or_else(|| Fault::Damaged(format!("`{text}` is not a number")))
    }

    /// Reads a number; `turn` puts its bytes in little-endian order.
    fn binary(&mut self, kind: Kind, turn: impl Fn(&mut [u8])) -> Result<f64, Fault> {
        let count = kind.bytes();
        let Some((bytes, rest)) = self.rest.split_at_checked(count) else {
            return damaged("it ends in the middle of its elements; it was cut off");
        };
        self.rest = rest;
        let mut word = [0; 8];
        word[..count].copy_from_slice(bytes);
        turn(&mut word[..count]);
        let [a, b, c, d, ..] = word;
        Ok(match kind {
            Kind::I8 => f64::from(a as i8),
            Kind::U8 => f64::from(a),
            Kind::I16 => f64::from(i16::from_le_bytes([a, b])),
            Kind::U16 => f64::from(u16::from_le_bytes([a, b])),
            Kind::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Kind::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Kind::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Kind::F64 => f64::from_le_bytes(word),
        })
    }
}
