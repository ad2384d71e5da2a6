//! The header of a PLY file.

use crate::load::error::{ModelFault, damaged};
use crate::load::text::decoded;

/// Most bytes of a header.
const MOST_BYTES: usize = 1 << 20;

/// Encoding of the data after the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyEncoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl NumberType {
    fn named(word: &str) -> Option<NumberType> {
        Some(match word {
            "char" | "int8" => NumberType::I8,
            "uchar" | "uint8" => NumberType::U8,
            "short" | "int16" => NumberType::I16,
            "ushort" | "uint16" => NumberType::U16,
            "int" | "int32" => NumberType::I32,
            "uint" | "uint32" => NumberType::U32,
            "float" | "float32" => NumberType::F32,
            "double" | "float64" => NumberType::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) fn bytes(self) -> usize {
        match self {
            NumberType::I8 | NumberType::U8 => 1,
            NumberType::I16 | NumberType::U16 => 2,
            NumberType::I32 | NumberType::U32 | NumberType::F32 => 4,
            NumberType::F64 => 8,
        }
    }

    /// Returns the code of full intensity, for integer colors.
    pub(super) fn largest_code(self) -> Option<f32> {
        match self {
            NumberType::U8 => Some(f32::from(u8::MAX)),
            NumberType::U16 => Some(f32::from(u16::MAX)),
            NumberType::U32 => Some(u32::MAX as f32),
            NumberType::I8 => Some(f32::from(i8::MAX)),
            NumberType::I16 => Some(f32::from(i16::MAX)),
            NumberType::I32 => Some(i32::MAX as f32),
            NumberType::F32 | NumberType::F64 => None,
        }
    }
}

/// A number or a list of numbers of each element.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: NumberType,
    /// Type of the number of entries of a list.
    pub(super) list: Option<NumberType>,
}

/// A list of items with the same properties.
pub(super) struct PlyElement {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl PlyElement {
    /// Place of a property among those of the element.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|property| property.name == name)
    }
}

/// Content of a header.
pub(super) struct PlyHeader {
    pub(super) encoding: PlyEncoding,
    pub(super) elements: Vec<PlyElement>,
    /// Paths of pictures, from comments `TextureFile`.
    pub(super) pictures: Vec<String>,
}

impl PlyHeader {
    /// The first element of a name.
    pub(super) fn element(&self, name: &str) -> Option<&PlyElement> {
        self.elements.iter().find(|element| element.name == name)
    }

    /// Parses the header, and also returns the rest of the file.
    pub(super) fn parse(bytes: &[u8]) -> Result<(PlyHeader, &[u8]), ModelFault> {
        let (text, rest) = split(bytes)?;
        let mut encoding = None;
        let mut header = PlyHeader {
            encoding: PlyEncoding::Text,
            elements: Vec::new(),
            pictures: Vec::new(),
        };
        let text = decoded(text);
        for line in text.split(['\n', '\r']).skip(1) {
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words[..] {
                ["format", name, ..] => encoding = Some(encoding_named(name)?),
                ["comment", "TextureFile", ..] => header.pictures.push(path_in(line).to_string()),
                ["element", name, count, ..] => {
                    let Ok(count) = count.parse() else {
                        return damaged(format!("`{count}` is not a number of elements"));
                    };
                    header.elements.push(PlyElement {
                        name: name.to_string(),
                        count,
                        properties: Vec::new(),
                    });
                }
                ["property", ref words @ ..] => {
                    let Some(element) = header.elements.last_mut() else {
                        return damaged("a property stands before any element");
                    };
                    element.properties.push(property(words)?);
                }
                _ => {}
            }
        }
        let Some(encoding) = encoding else {
            return damaged("its header does not say its format");
        };
        header.encoding = encoding;
        Ok((header, rest))
    }
}

/// Splits a file after the line `end_header`.
fn split(bytes: &[u8]) -> Result<(&[u8], &[u8]), ModelFault> {
    let start = &bytes[..bytes.len().min(MOST_BYTES)];
    let mut from = 0;
    // In a file whose lines end in carriage returns, a line feed behind the last one is the first byte of its elements.
    let mut ends_in_returns = false;
    while let Some(length) = start[from..].iter().position(|byte| matches!(byte, b'\n' | b'\r')) {
        let end = from + length;
        let is_last = start[from..end].trim_ascii() == b"end_header";
        let two = start[end] == b'\r' && start.get(end + 1) == Some(&b'\n') && !(is_last && ends_in_returns);
        ends_in_returns = start[end] == b'\r' && !two;
        from = end + if two { 2 } else { 1 };
        if is_last {
            return Ok((&bytes[..end], &bytes[from..]));
        }
    }
    damaged("its header has no end")
}

fn encoding_named(name: &str) -> Result<PlyEncoding, ModelFault> {
    match name {
        "ascii" => Ok(PlyEncoding::Text),
        "binary_little_endian" => Ok(PlyEncoding::LittleEndian),
        "binary_big_endian" => Ok(PlyEncoding::BigEndian),
        other => damaged(format!("its format `{other}` is unknown")),
    }
}

fn property(words: &[&str]) -> Result<Property, ModelFault> {
    let kind = |word: &str| {
        NumberType::named(word).ok_or_else(|| ModelFault::Damaged(format!("`{word}` is no type of a property")))
    };
    match words {
        ["list", count, entries, name, ..] => Ok(Property {
            name: name.to_string(),
            kind: kind(entries)?,
            list: Some(kind(count)?),
        }),
        [one, name, ..] => Ok(Property {
            name: name.to_string(),
            kind: kind(one)?,
            list: None,
        }),
        _ => damaged("a property has no name"),
    }
}

/// The path in a comment `TextureFile`, which may have spaces.
fn path_in(line: &str) -> &str {
    line.split_once("TextureFile").map_or("", |(_, path)| path.trim_ascii())
}
