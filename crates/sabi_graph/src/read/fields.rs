//! Reads the known keys of an object one by one. Keys that are not read are kept as unknown keys.

use std::collections::BTreeMap;

use crate::Value;
use crate::file_error::{FileProblem, ReadError};
use crate::format::ObjectKeys;
use crate::json::{Json, Member, Tree};
use crate::problem::{Problem, quoted};

pub(super) struct Fields {
    /// Offset of the object in the text.
    at: usize,
    /// All keys that are known for this object.
    known: &'static ObjectKeys,
    members: BTreeMap<String, Json>,
}

impl Fields {
    /// Takes the members of an object. `what` describes the value in the error for a value that is not an object.
    pub(super) fn of(json: Json, what: &str, known: &'static ObjectKeys) -> Result<Self, ReadError> {
        let at = json.at;
        let members = members(json, what)?
            .into_iter()
            .map(|member| (member.key, member.value));
        Ok(Fields {
            at,
            known,
            members: members.collect(),
        })
    }

    pub(super) fn take(&mut self, key: &str) -> Option<Json> {
        debug_assert!(self.known.has(key), "{key} is no key of {}", self.known.name);
        self.members.remove(key)
    }

    /// Returns the value of a required key.
    pub(super) fn need(&mut self, key: &str, advice: &'static str) -> Result<Json, ReadError> {
        let missing = FileProblem::Missing {
            key: quoted(key),
            advice,
        };
        self.take(key).ok_or_else(|| ReadError::new(self.at, missing))
    }

    pub(super) fn text(&mut self, key: &str) -> Result<Option<String>, ReadError> {
        self.take(key).map(|json| text(json, key)).transpose()
    }

    pub(super) fn flag(&mut self, key: &str) -> Result<bool, ReadError> {
        match self.take(key) {
            None => Ok(false),
            Some(Json {
                tree: Tree::Bool(yes), ..
            }) => Ok(yes),
            Some(other) => Err(ReadError::expected(&other, key, "true or false")),
        }
    }

    /// Reads a whole number that fits into 32 bits.
    pub(super) fn whole(&mut self, key: &str) -> Result<Option<u32>, ReadError> {
        let Some(json) = self.take(key) else {
            return Ok(None);
        };
        match json.tree {
            Tree::Number(x) if x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&x) => Ok(Some(x as u32)),
            _ => Err(ReadError::expected(&json, key, "a whole number from 0 to 4294967295")),
        }
    }

    /// Reads two numbers.
    pub(super) fn pair(&mut self, key: &str) -> Result<Option<[f64; 2]>, ReadError> {
        self.numbers(key, "a list of two numbers")
    }

    /// Reads `N` numbers. `expected` describes them in the error.
    pub(super) fn numbers<const N: usize>(
        &mut self,
        key: &str,
        expected: &'static str,
    ) -> Result<Option<[f64; N]>, ReadError> {
        let Some(json) = self.take(key) else {
            return Ok(None);
        };
        let number = |item: &Json| match item.tree {
            Tree::Number(number) => Some(number),
            _ => None,
        };
        let found = match &json.tree {
            Tree::List(items) => items.iter().map(number).collect::<Option<Vec<f64>>>(),
            _ => None,
        };
        match found.and_then(|found| found.try_into().ok()) {
            Some(numbers) => Ok(Some(numbers)),
            None => Err(ReadError::expected(&json, key, expected)),
        }
    }

    pub(super) fn number(&mut self, key: &str) -> Result<Option<f64>, ReadError> {
        match self.take(key) {
            None => Ok(None),
            Some(Json {
                tree: Tree::Number(number),
                ..
            }) => Ok(Some(number)),
            Some(other) => Err(ReadError::expected(&other, key, "a number")),
        }
    }

    /// Returns the members of the object under a key; none if the key is missing.
    pub(super) fn map(&mut self, key: &str) -> Result<Vec<Member>, ReadError> {
        self.take(key).map_or(Ok(Vec::new()), |json| members(json, key))
    }

    /// Returns the texts of the list under a key, with their offsets; none if the key is missing.
    pub(super) fn texts(&mut self, key: &str) -> Result<Vec<(usize, String)>, ReadError> {
        match self.take(key) {
            None => Ok(Vec::new()),
            Some(Json {
                tree: Tree::List(items),
                ..
            }) => items.into_iter().map(|item| Ok((item.at, text(item, key)?))).collect(),
            Some(other) => Err(ReadError::expected(&other, key, "a list of texts")),
        }
    }

    /// All keys that were not read.
    pub(super) fn extra(self) -> Result<BTreeMap<String, Value>, ReadError> {
        let kept = |(key, json): (String, Json)| {
            let value = value(json, &key)?;
            Ok((key, value))
        };
        self.members.into_iter().map(kept).collect()
    }
}

/// The members of an object under the key `what`.
pub(super) fn members(json: Json, what: &str) -> Result<Vec<Member>, ReadError> {
    match json.tree {
        Tree::Object(members) => Ok(members),
        _ => Err(ReadError::expected(&json, what, "an object in braces")),
    }
}

pub(super) fn text(json: Json, key: &str) -> Result<String, ReadError> {
    match json.tree {
        Tree::Text(text) => Ok(text),
        _ => Err(ReadError::expected(&json, key, "a text in quotes")),
    }
}

/// Reads a value of any type.
pub(super) fn value(json: Json, name: &str) -> Result<Value, ReadError> {
    let at = json.at;
    let bad = || ReadError::new(at, Problem::BadValue { name: quoted(name) });
    json.into_value().canonical().ok_or_else(bad)
}
