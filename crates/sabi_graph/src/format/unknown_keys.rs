//! Keys of a graph file that this version does not read: keys of a newer version, or misspelled ones.

use std::fmt;

use super::{DOCUMENT, ObjectKey, ObjectKeys, ValueShape};
use crate::json::{Json, Tree, parse};
use crate::migrate::to_newest;
use crate::problem::{listed, quoted};
use crate::text_position::line_and_column;

/// Key of a graph file that this version does not read. It is kept when the file is saved. Prints as a sentence with line and column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownKey {
    /// Line in the text, from 1.
    pub line: usize,
    /// Column in the line, in characters from 1.
    pub column: usize,
    /// Object that contains the key, such as `node "edges"`.
    pub place: String,
    /// The key.
    pub key: String,
    /// The known key that was probably meant.
    pub meant: Option<&'static str>,
    /// Known keys that the object does not have, as candidates for a suggestion.
    free: Vec<&'static str>,
}

impl fmt::Display for UnknownKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (place, key) = (&self.place, quoted(&self.key));
        write!(f, "{place} has a key {key}, which nothing reads; ")?;
        match self.meant {
            Some(meant) => write!(f, "did you mean {}?", quoted(meant)),
            None => write!(f, "there is also {}", listed(self.free.iter().copied())),
        }
    }
}

/// Keys of a graph file that nothing reads.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnknownKeys {
    /// The first ones, in their order.
    pub first: Vec<UnknownKey>,
    /// Number of the others: a file may have any number of them.
    pub more: usize,
}

/// Most keys that are described: the place of each is counted from the beginning of the text.
const MOST_DESCRIBED: usize = 100;

/// Lists the unknown keys in the text of a graph file. There are none in a text that is not a graph.
pub fn unknown_keys(text: &str) -> UnknownKeys {
    let Some(json) = parse(text).ok().and_then(|json| to_newest(json).ok()) else {
        return UnknownKeys::default();
    };
    let mut search = Search {
        text,
        found: Vec::new(),
        more: 0,
    };
    search.object(&json, &DOCUMENT, "the graph", "");
    search.found.sort_by_key(|(at, _)| *at);
    UnknownKeys {
        first: search.found.into_iter().map(|(_, key)| key).collect(),
        more: search.more,
    }
}

struct Search<'t> {
    text: &'t str,
    /// The first keys with their offsets.
    found: Vec<(usize, UnknownKey)>,
    /// Number of the others.
    more: usize,
}

impl Search<'_> {
    /// Searches an object with fixed keys. `of` is appended to descriptions of what the object contains, such as ` of group "rust"`.
    fn object(&mut self, json: &Json, keys: &'static ObjectKeys, place: &str, of: &str) {
        let Tree::Object(members) = &json.tree else { return };
        let is_free = |name: &&str| members.iter().all(|member| member.key != **name);
        for member in members {
            match keys.keys.iter().find(|known| known.name == member.key) {
                Some(known) => self.value(&member.value, known, place, of),
                None if self.found.len() == MOST_DESCRIBED => self.more += 1,
                None => {
                    let (line, column) = line_and_column(self.text, member.key_at);
                    // A key that is present already cannot be the one that was meant.
                    let free: Vec<&str> = keys.keys.iter().map(|known| known.name).filter(is_free).collect();
                    let key = UnknownKey {
                        line,
                        column,
                        place: place.to_owned(),
                        key: member.key.clone(),
                        meant: meant(&member.key, &free),
                        free,
                    };
                    self.found.push((member.key_at, key));
                }
            }
        }
    }

    fn value(&mut self, json: &Json, key: &'static ObjectKey, place: &str, of: &str) {
        match (&key.value, &json.tree) {
            (ValueShape::Object(keys), _) => self.object(json, keys, &format!("\"{}\" of {place}", key.name), of),
            (ValueShape::Objects(keys), Tree::Object(members)) => {
                for member in members {
                    let place = format!("{} {}{of}", keys.name, quoted(&member.key));
                    let of = match keys.name {
                        "group" => format!(" of {place}"),
                        _ => of.to_owned(),
                    };
                    self.object(&member.value, keys, &place, &of);
                }
            }
            _ => {}
        }
    }
}

/// Returns the known key that was probably meant: one with few different letters, one that starts with `key`, or one that
/// `key` starts with.
fn meant(key: &str, free: &[&'static str]) -> Option<&'static str> {
    let near = crate::nearest(key, free.iter().copied());
    let begins = || {
        free.iter()
            .copied()
            .find(|known| known.len() >= 4 && key.starts_with(known))
    };
    near.or_else(begins)
}
