//! The elements after the header of a PLY file.

use super::header::{NumberType, PlyElement, PlyEncoding};
use crate::load::error::{ModelFault, damaged};
use crate::load::numbers::number;
use crate::load::warnings::Warnings;
use sabi_cancel::CancelableIterator as _;

/// Value of a property.
pub(super) enum PropertyValue {
    Number(f64),
    List(Vec<f64>),
}

/// Bytes that have not been read yet.
pub(super) struct PlyBody<'b> {
    encoding: PlyEncoding,
    rest: &'b [u8],
    /// Warnings about numbers of a text.
    pub(super) warnings: Warnings,
}

impl<'b> PlyBody<'b> {
    pub(super) fn new(encoding: PlyEncoding, rest: &'b [u8]) -> PlyBody<'b> {
        PlyBody {
            encoding,
            rest,
            warnings: Warnings::default(),
        }
    }

    /// Returns a fault if the file is too short for the element's count.
    pub(super) fn check_room(&self, element: &PlyElement) -> Result<(), ModelFault> {
        let least = |binary: usize| match self.encoding {
            // A digit and a space.
            PlyEncoding::Text => 2,
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
    pub(super) fn row(&mut self, element: &PlyElement, row: &mut Vec<PropertyValue>) -> Result<(), ModelFault> {
        row.truncate(element.properties.len());
        for (place, property) in element.properties.iter().enumerate() {
            let value = match property.list {
                None => PropertyValue::Number(self.number(property.kind)?),
                Some(count) => {
                    let mut entries = match row.get_mut(place) {
                        Some(PropertyValue::List(entries)) => std::mem::take(entries),
                        _ => Vec::new(),
                    };
                    self.list(count, property.kind, &mut entries)?;
                    PropertyValue::List(entries)
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
    pub(super) fn skip(&mut self, element: &PlyElement) -> Result<(), ModelFault> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row = Vec::new();
        for _ in (0..element.count).looking() {
            self.row(element, &mut row)?;
        }
        Ok(())
    }

    fn list(&mut self, count: NumberType, kind: NumberType, entries: &mut Vec<f64>) -> Result<(), ModelFault> {
        let count = self.number(count)?;
        let most = match self.encoding {
            PlyEncoding::Text => self.rest.len() / 2 + 1,
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

    fn number(&mut self, kind: NumberType) -> Result<f64, ModelFault> {
        match self.encoding {
            PlyEncoding::Text => self.word(),
            PlyEncoding::LittleEndian => self.binary(kind, |_| {}),
            PlyEncoding::BigEndian => self.binary(kind, <[u8]>::reverse),
        }
    }

    fn word(&mut self) -> Result<f64, ModelFault> {
        let start = self.rest.trim_ascii_start();
        let end = start.iter().position(u8::is_ascii_whitespace).unwrap_or(start.len());
        let (word, rest) = start.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return damaged("it ends in the middle of its elements; it was cut off");
        }
        // A word that is not UTF-8 is not a number.
        let text = String::from_utf8_lossy(word);
        number(&text, &mut self.warnings).ok_or_else(|| ModelFault::Damaged(format!("`{text}` is not a number")))
    }

    /// Reads a number; `turn` puts its bytes in little-endian order.
    fn binary(&mut self, kind: NumberType, turn: impl Fn(&mut [u8])) -> Result<f64, ModelFault> {
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
            NumberType::I8 => f64::from(a as i8),
            NumberType::U8 => f64::from(a),
            NumberType::I16 => f64::from(i16::from_le_bytes([a, b])),
            NumberType::U16 => f64::from(u16::from_le_bytes([a, b])),
            NumberType::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            NumberType::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            NumberType::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            NumberType::F64 => f64::from_le_bytes(word),
        })
    }
}
