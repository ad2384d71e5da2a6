//! Parser from JSON text to a tree with byte offsets.
//!
//! It is strict: no trailing commas, no comments, no duplicate keys. It exists because JSON libraries discard offsets,
//! which errors about the content of a file need to name its lines.

use std::collections::BTreeSet;

use crate::problem::quoted;
use crate::value::{Value, canonical_number};

/// A value with the byte offset at which it starts.
#[derive(Clone, Debug)]
pub(crate) struct Json {
    pub(crate) at: usize,
    pub(crate) tree: Tree,
}

/// A value.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Vec<Member>),
}

/// A key and its value, with the byte offset of the key.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) key: String,
    pub(crate) key_at: usize,
    pub(crate) value: Json,
}

/// Syntax error of a text that is not JSON, with its byte offset.
#[derive(Debug)]
pub(crate) struct JsonError {
    pub(crate) at: usize,
    pub(crate) kind: JsonErrorKind,
}

/// Kinds of syntax errors.
#[derive(Debug)]
pub(crate) enum JsonErrorKind {
    /// A sentence.
    Syntax(String),
    /// Too many bytes or values.
    TooLarge,
}

const BYTE_LIMIT: usize = 64 << 20;
const VALUE_LIMIT: usize = 4_000_000;
const DEPTH_LIMIT: usize = 128;

impl Json {
    /// The value without offsets. Parsed objects have no duplicate keys.
    pub(crate) fn into_value(self) -> Value {
        match self.tree {
            Tree::Null => Value::Null,
            Tree::Bool(yes) => Value::Bool(yes),
            Tree::Number(x) => Value::Number(x),
            Tree::Text(text) => Value::Text(text),
            Tree::List(items) => Value::List(items.into_iter().map(Json::into_value).collect()),
            Tree::Object(members) => Value::Object(
                members
                    .into_iter()
                    .map(|member| (member.key, member.value.into_value()))
                    .collect(),
            ),
        }
    }

    /// Description of the value for messages: `the number 3`, `a list`.
    pub(crate) fn description(&self) -> String {
        match &self.tree {
            Tree::Null => "null".to_owned(),
            Tree::Bool(yes) => yes.to_string(),
            Tree::Number(x) => format!("the number {}", crate::value::number_text(*x)),
            Tree::Text(text) => format!("the text {}", quoted(text)),
            Tree::List(_) => "a list".to_owned(),
            Tree::Object(_) => "an object".to_owned(),
        }
    }
}

/// Reads one JSON value and nothing after it.
pub(crate) fn parse(text: &str) -> Result<Json, JsonError> {
    parse_value(text).map_err(|error| conflict(text).unwrap_or(error))
}

/// Starts of the lines that git writes around both sides of a conflict. JSON texts contain no line breaks, so no line of a
/// valid graph file starts with one of these.
const CONFLICT_MARKERS: [&str; 4] = ["<<<<<<<", "|||||||", "=======", ">>>>>>>"];

/// Returns the error for a text that is not JSON because it contains a merge conflict.
fn conflict(text: &str) -> Option<JsonError> {
    let is_marker = |line: &str| CONFLICT_MARKERS.iter().any(|marker| line.starts_with(marker));
    let mut at = 0;
    let marker = text.split_inclusive('\n').find(|line| {
        let is_found = is_marker(line);
        at += if is_found { 0 } else { line.len() };
        is_found
    })?;
    let sentence = format!(
        "{} is a conflict marker of git: two versions of the graph were merged and differ here; keep one side or both, and remove \
         the lines that begin with <<<<<<<, ======= and >>>>>>>",
        quoted(marker.trim_end())
    );
    Some(JsonError {
        at,
        kind: JsonErrorKind::Syntax(sentence),
    })
}

fn parse_value(text: &str) -> Result<Json, JsonError> {
    if text.len() > BYTE_LIMIT {
        return Err(JsonError {
            at: 0,
            kind: JsonErrorKind::TooLarge,
        });
    }
    let mut parser = Parser { text, at: 0, values: 0 };
    // Skip a byte order mark, which some Windows editors write.
    if text.starts_with('\u{feff}') {
        parser.at = '\u{feff}'.len_utf8();
    }
    let json = parser.value(0)?;
    parser.space();
    match parser.peek() {
        None => Ok(json),
        Some(_) => Err(parser.error("the file goes on after its closing brace; remove what follows")),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    values: usize,
}

impl Parser<'_> {
    fn error(&self, sentence: impl Into<String>) -> JsonError {
        JsonError {
            at: self.at,
            kind: JsonErrorKind::Syntax(sentence.into()),
        }
    }

    /// Returns the error for an unexpected character at the current place.
    fn unexpected(&self, expected: &str) -> JsonError {
        match self.text[self.at..].chars().next() {
            None => self.error(format!(
                "the file ends where {expected} is expected; it may have been cut off"
            )),
            Some(c) => self.error(format!("{expected} is expected here, not {c:?}")),
        }
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn eat(&mut self, byte: u8) -> bool {
        let here = self.peek() == Some(byte);
        self.at += usize::from(here);
        here
    }

    fn space(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    fn value(&mut self, depth: usize) -> Result<Json, JsonError> {
        self.space();
        self.values += 1;
        if self.values > VALUE_LIMIT {
            return Err(JsonError {
                at: self.at,
                kind: JsonErrorKind::TooLarge,
            });
        }
        if depth > DEPTH_LIMIT {
            return Err(self.error(format!(
                "values are nested more than {DEPTH_LIMIT} deep here; flatten them"
            )));
        }
        let at = self.at;
        let tree = match self.peek() {
            Some(b'{') => self.object(depth)?,
            Some(b'[') => self.list(depth)?,
            Some(b'"') => Tree::Text(self.string()?),
            Some(b'-' | b'0'..=b'9') => Tree::Number(self.number()?),
            Some(b'a'..=b'z' | b'A'..=b'Z') => self.word()?,
            _ => return Err(self.unexpected("a value")),
        };
        Ok(Json { at, tree })
    }

    fn object(&mut self, depth: usize) -> Result<Tree, JsonError> {
        self.at += 1;
        let mut members = Vec::new();
        let mut keys = BTreeSet::new();
        self.space();
        if self.eat(b'}') {
            return Ok(Tree::Object(members));
        }
        loop {
            self.space();
            let key_at = self.at;
            if self.peek() != Some(b'"') {
                return Err(self.unexpected("a key in quotes"));
            }
            let key = self.string()?;
            if !keys.insert(key.clone()) {
                self.at = key_at;
                return Err(self.error(format!(
                    "the key {} stands here a second time; keep one of them",
                    quoted(&key)
                )));
            }
            self.space();
            if !self.eat(b':') {
                return Err(self.unexpected("a colon"));
            }
            let value = self.value(depth + 1)?;
            members.push(Member { key, key_at, value });
            self.space();
            if self.eat(b'}') {
                return Ok(Tree::Object(members));
            }
            if !self.eat(b',') {
                return Err(self.unexpected("a comma or a closing brace"));
            }
        }
    }

    fn list(&mut self, depth: usize) -> Result<Tree, JsonError> {
        self.at += 1;
        let mut items = Vec::new();
        self.space();
        if self.eat(b']') {
            return Ok(Tree::List(items));
        }
        loop {
            items.push(self.value(depth + 1)?);
            self.space();
            if self.eat(b']') {
                return Ok(Tree::List(items));
            }
            if !self.eat(b',') {
                return Err(self.unexpected("a comma or a closing bracket"));
            }
        }
    }

    fn word(&mut self) -> Result<Tree, JsonError> {
        let rest = &self.text[self.at..];
        for (word, tree) in [
            ("null", Tree::Null),
            ("true", Tree::Bool(true)),
            ("false", Tree::Bool(false)),
        ] {
            let after = rest.as_bytes().get(word.len());
            if rest.starts_with(word) && !after.is_some_and(u8::is_ascii_alphanumeric) {
                self.at += word.len();
                return Ok(tree);
            }
        }
        let end = rest
            .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        Err(self.error(format!(
            "{} is no JSON value; texts stand in quotes",
            quoted(&rest[..end])
        )))
    }

    fn digits(&mut self) -> usize {
        let start = self.at;
        while matches!(self.peek(), Some(b'0'..=b'9')) {
            self.at += 1;
        }
        self.at - start
    }

    fn number(&mut self) -> Result<f64, JsonError> {
        let start = self.at;
        self.eat(b'-');
        let leading_zero = self.peek() == Some(b'0');
        let whole = self.digits();
        let mut good = whole > 0 && !(leading_zero && whole > 1);
        if self.eat(b'.') {
            good &= self.digits() > 0;
        }
        if self.eat(b'e') || self.eat(b'E') {
            if !self.eat(b'+') {
                self.eat(b'-');
            }
            good &= self.digits() > 0;
        }
        let text = &self.text[start..self.at];
        let number = if good { text.parse::<f64>().ok() } else { None };
        let Some(number) = number else {
            self.at = start;
            return Err(self.error(format!("{} is not how JSON writes a number", quoted(text))));
        };
        canonical_number(number).ok_or_else(|| {
            let sentence = format!("the number {} is too large; numbers go up to 3.4e38", quoted(text));
            JsonError {
                at: start,
                kind: JsonErrorKind::Syntax(sentence),
            }
        })
    }

    fn string(&mut self) -> Result<String, JsonError> {
        let start = self.at;
        self.at += 1;
        let mut text = String::new();
        loop {
            let rest = &self.text[self.at..];
            let plain = rest
                .find(|c: char| c == '"' || c == '\\' || (c as u32) < 0x20)
                .unwrap_or(rest.len());
            text.push_str(&rest[..plain]);
            self.at += plain;
            match self.peek() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(text);
                }
                Some(b'\\') => text.push(self.escape()?),
                Some(_) => {
                    return Err(
                        self.error("a text may not hold a line break or control character; write it as \\n or \\u00xx")
                    );
                }
                None => {
                    self.at = start;
                    return Err(self.error("the file ends inside the text that begins here; it may have been cut off"));
                }
            }
        }
    }

    fn escape(&mut self) -> Result<char, JsonError> {
        let start = self.at;
        self.at += 1;
        let letter = self.peek();
        self.at += usize::from(letter.is_some_and(|byte| byte.is_ascii()));
        let escaped = match letter {
            Some(c @ (b'"' | b'\\' | b'/')) => Some(char::from(c)),
            Some(b'b') => Some('\u{8}'),
            Some(b'f') => Some('\u{c}'),
            Some(b'n') => Some('\n'),
            Some(b'r') => Some('\r'),
            Some(b't') => Some('\t'),
            Some(b'u') => self.unicode(),
            _ => None,
        };
        escaped.ok_or_else(|| {
            self.at = start;
            self.error("this escape is not one JSON knows; a backslash itself is written \\\\")
        })
    }

    /// Reads the four digits of a `\u` escape, after the `u`, and returns the character; `None` for a lone surrogate.
    fn unicode(&mut self) -> Option<char> {
        let first = self.hex()?;
        if !(0xd800..0xdc00).contains(&first) {
            return char::from_u32(first);
        }
        if !(self.eat(b'\\') && self.eat(b'u')) {
            return None;
        }
        let second = self.hex()?;
        let low = second.checked_sub(0xdc00).filter(|low| *low < 0x400)?;
        char::from_u32(0x10000 + ((first - 0xd800) << 10) + low)
    }

    fn hex(&mut self) -> Option<u32> {
        let digits = self.text.get(self.at..self.at + 4)?;
        if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return None;
        }
        self.at += 4;
        u32::from_str_radix(digits, 16).ok()
    }
}
