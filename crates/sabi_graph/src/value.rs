//! Values of parameters: JSON values with numbers in canonical form.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Serialize, Serializer};

/// Value of a parameter or an unknown key.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// A finite number; files keep whole numbers below 2⁵³ exactly and all others at `f32` precision.
    Number(f64),
    /// A string.
    Text(String),
    /// A list.
    List(Vec<Value>),
    /// An object; keys are sorted.
    Object(BTreeMap<String, Value>),
}

/// Upper limit of whole numbers that a file stores exactly.
const WHOLE_LIMIT: f64 = 9_007_199_254_740_992.0;

/// Maximum nesting of values. Deeper ones are refused, so that every saved document can be read again.
pub(crate) const DEPTH_LIMIT: usize = 64;

/// Returns the number that a file stores for `x`. Whole numbers below 2⁵³ are stored exactly, others as their shortest
/// `f32` text; there is no negative zero. Returns `None` if `x` is not finite or too large for an `f32`.
pub fn canonical_number(x: f64) -> Option<f64> {
    if x.fract() == 0.0 && x.abs() < WHOLE_LIMIT {
        return Some(x + 0.0);
    }
    // Infinities and NaN have no canonical form; the shortest text of any other float can be parsed.
    let single = x as f32;
    if !single.is_finite() {
        return None;
    }
    let read_back: f64 = single.to_string().parse().ok()?;
    Some(read_back + 0.0)
}

/// Returns the canonical text of a number; `null` for a number that no file can hold.
pub(crate) fn number_text(x: f64) -> String {
    match canonical_number(x) {
        // `Display` writes no exponents and the shortest digits that give the same number back.
        Some(x) => x.to_string(),
        None => "null".to_owned(),
    }
}

impl Value {
    /// Returns the canonical form of this value (see [`canonical_number`]), or `None` if it contains a number that is not
    /// finite or beyond `f32`, or if it is nested deeper than 64 levels.
    pub fn canonical(self) -> Option<Value> {
        self.canonical_within(DEPTH_LIMIT)
    }

    fn canonical_within(self, depth: usize) -> Option<Value> {
        let inner = depth.checked_sub(1)?;
        Some(match self {
            Value::Number(x) => Value::Number(canonical_number(x)?),
            Value::List(items) => Value::List(
                items
                    .into_iter()
                    .map(|item| item.canonical_within(inner))
                    .collect::<Option<_>>()?,
            ),
            Value::Object(members) => Value::Object(
                members
                    .into_iter()
                    .map(|(key, item)| Some((key, item.canonical_within(inner)?)))
                    .collect::<Option<_>>()?,
            ),
            other => other,
        })
    }

    /// Returns the number, if this value is a number.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Value::Number(x) => Some(*x),
            _ => None,
        }
    }

    /// Returns the number as a `u32`, if this value is a whole number in that range.
    pub fn as_u32(&self) -> Option<u32> {
        match self {
            Value::Number(x) if x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(x) => Some(*x as u32),
            _ => None,
        }
    }

    /// Returns the text, if this value is a text.
    pub fn as_text(&self) -> Option<&str> {
        match self {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Returns the truth value, if this value is one.
    pub fn as_bool(&self) -> Option<bool> {
        match self {
            Value::Bool(yes) => Some(*yes),
            _ => None,
        }
    }

    /// Returns the items, if this value is a list.
    pub fn as_list(&self) -> Option<&[Value]> {
        match self {
            Value::List(items) => Some(items),
            _ => None,
        }
    }

    /// Returns advice, with a semicolon before it, for a text that is a number with a decimal comma; empty for other values.
    pub fn decimal_comma_advice(&self) -> &'static str {
        let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        let halves = self.as_text().and_then(|text| text.split_once(','));
        match halves {
            Some((whole, part)) if is_digits(whole.trim_start_matches(['-', '+'])) && is_digits(part) => {
                "; write the decimal point, as in 0.5"
            }
            _ => "",
        }
    }

    /// Returns the name of this value's type with its article, for messages: `a number`, `a list`.
    pub(crate) fn type_with_article(&self) -> &'static str {
        match self {
            Value::Null => "null",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Object(_) => "an object",
        }
    }
}

impl Serialize for Value {
    /// Writes numbers in the form of [`canonical_number`], whole ones without a decimal point.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Value::Null => serializer.serialize_unit(),
            Value::Bool(yes) => serializer.serialize_bool(*yes),
            Value::Number(number) => match canonical_number(*number) {
                Some(whole) if whole.fract() == 0.0 && whole.abs() < WHOLE_LIMIT => {
                    serializer.serialize_i64(whole as i64)
                }
                Some(number) => serializer.serialize_f64(number),
                None => serializer.serialize_unit(),
            },
            Value::Text(text) => serializer.serialize_str(text),
            Value::List(items) => items.serialize(serializer),
            Value::Object(members) => members.serialize(serializer),
        }
    }
}

impl From<bool> for Value {
    fn from(yes: bool) -> Self {
        Value::Bool(yes)
    }
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Value::Number(x)
    }
}

impl From<u32> for Value {
    fn from(x: u32) -> Self {
        Value::Number(f64::from(x))
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Value::Text(text)
    }
}

impl<T: Into<Value>> From<Vec<T>> for Value {
    fn from(items: Vec<T>) -> Self {
        Value::List(items.into_iter().map(Into::into).collect())
    }
}

impl fmt::Display for Value {
    /// Writes the value as JSON on one line, for messages and keys.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Null => f.write_str("null"),
            Value::Bool(on) => write!(f, "{on}"),
            Value::Number(number) => f.write_str(&number_text(*number)),
            Value::Text(text) => write!(f, "{text:?}"),
            Value::List(items) => {
                f.write_str("[")?;
                for (index, item) in items.iter().enumerate() {
                    write!(f, "{}{item}", if index > 0 { ", " } else { "" })?;
                }
                f.write_str("]")
            }
            Value::Object(members) => {
                f.write_str("{")?;
                for (index, (key, item)) in members.iter().enumerate() {
                    write!(f, "{}{key:?}: {item}", if index > 0 { ", " } else { "" })?;
                }
                f.write_str("}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_in_canonical_form() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-3.0, "-3"),
            (0.1, "0.1"),
            (f64::from(0.1f32), "0.1"),
            (1.0 / 3.0, "0.33333334"),
            (4_294_967_295.0, "4294967295"),
            (9_007_199_254_740_991.0, "9007199254740991"),
            (1e20, "100000000000000000000"),
            (1e-60, "0"),
            (-1e-60, "0"),
            (f64::NAN, "null"),
            (1e300, "null"),
        ] {
            assert_eq!(number_text(x), text, "{x:e}");
        }
    }

    #[test]
    fn every_float_is_read_back_unchanged() {
        for bits in (0..=u32::MAX).step_by(1_000_003) {
            let x = f32::from_bits(bits);
            if x.is_finite() {
                let text = number_text(f64::from(x));
                assert_eq!(text.parse::<f32>().unwrap(), x, "{text}");
                assert_eq!(number_text(text.parse().unwrap()), text);
            }
        }
    }

    #[test]
    fn values_that_no_file_can_hold_have_no_canonical_form() {
        assert_eq!(Value::Number(f64::INFINITY).canonical(), None);
        let deep = (0..100).fold(Value::Null, |inner, _| Value::List(vec![inner]));
        assert_eq!(deep.canonical(), None);
        assert_eq!(
            Value::from(vec![1.0 / 3.0]).canonical(),
            Some(Value::from(vec![0.33333334]))
        );
    }
}
