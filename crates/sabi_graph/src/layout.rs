//! The canonical layout of JSON text.
//!
//! Indentation is two spaces, with one key a line. Lists of scalars are written on one line, other lists with one item a line.

use std::collections::BTreeMap;

use crate::value::{Value, number_text};

/// Object to be written, with its keys in order.
#[derive(Default)]
pub(crate) struct OrderedObject(Vec<(String, LayoutItem)>);

/// Value to be written.
pub(crate) enum LayoutItem {
    Value(Value),
    Object(OrderedObject),
}

impl OrderedObject {
    /// Adds a key with a value.
    pub(crate) fn put(&mut self, key: &str, value: impl Into<Value>) {
        self.0.push((key.to_owned(), LayoutItem::Value(value.into())));
    }

    /// Adds a key, if there is a value.
    pub(crate) fn put_some(&mut self, key: &str, value: Option<impl Into<Value>>) {
        if let Some(value) = value {
            self.put(key, value);
        }
    }

    /// Adds a key with an object.
    pub(crate) fn put_object(&mut self, key: &str, object: OrderedObject) {
        self.0.push((key.to_owned(), LayoutItem::Object(object)));
    }

    /// Adds a key with an object whose members `each` creates, unless the map is empty.
    pub(crate) fn put_map<K: ToString, V>(&mut self, key: &str, map: &BTreeMap<K, V>, each: impl Fn(&V) -> LayoutItem) {
        if !map.is_empty() {
            let members = map.iter().map(|(name, value)| (name.to_string(), each(value)));
            self.put_object(key, OrderedObject(members.collect()));
        }
    }

    /// Adds the unknown keys, sorted. Keys that this version knows are left out.
    pub(crate) fn put_extra(&mut self, extra: &BTreeMap<String, Value>, is_known: impl Fn(&str) -> bool) {
        for (key, value) in extra {
            if !is_known(key.as_str()) {
                self.put(key, value.clone());
            }
        }
    }

    /// Adds a member.
    pub(crate) fn push(&mut self, key: String, item: LayoutItem) {
        self.0.push((key, item));
    }

    /// Returns the text of the whole file.
    pub(crate) fn into_text(self) -> String {
        let mut text = String::new();
        write_item(&mut text, &LayoutItem::Object(self), 0);
        text.push('\n');
        text
    }
}

/// A value on one line.
pub(crate) fn one_line(value: &Value) -> String {
    let mut text = String::new();
    write_inline(&mut text, value);
    text
}

fn write_item(text: &mut String, item: &LayoutItem, indent: usize) {
    match item {
        LayoutItem::Value(value) => write_value(text, value, indent),
        LayoutItem::Object(OrderedObject(members)) => {
            let members = members.iter().map(|(key, item)| (key.as_str(), item));
            write_members(text, members, indent, write_item);
        }
    }
}

fn write_value(text: &mut String, value: &Value, indent: usize) {
    match value {
        Value::Object(members) => {
            let members = members.iter().map(|(key, item)| (key.as_str(), item));
            write_members(text, members, indent, write_value);
        }
        Value::List(items)
            if items
                .iter()
                .any(|item| matches!(item, Value::List(_) | Value::Object(_))) =>
        {
            text.push('[');
            for (place, item) in items.iter().enumerate() {
                text.push_str(if place == 0 { "\n" } else { ",\n" });
                pad(text, indent + 1);
                write_value(text, item, indent + 1);
            }
            text.push('\n');
            pad(text, indent);
            text.push(']');
        }
        _ => write_inline(text, value),
    }
}

fn write_members<'a, T: 'a>(
    text: &mut String,
    members: impl ExactSizeIterator<Item = (&'a str, &'a T)>,
    indent: usize,
    write: fn(&mut String, &T, usize),
) {
    if members.len() == 0 {
        text.push_str("{}");
        return;
    }
    text.push('{');
    for (place, (key, item)) in members.enumerate() {
        text.push_str(if place == 0 { "\n" } else { ",\n" });
        pad(text, indent + 1);
        write_text(text, key);
        text.push_str(": ");
        write(text, item, indent + 1);
    }
    text.push('\n');
    pad(text, indent);
    text.push('}');
}

fn write_inline(text: &mut String, value: &Value) {
    match value {
        Value::Null => text.push_str("null"),
        Value::Bool(yes) => text.push_str(if *yes { "true" } else { "false" }),
        Value::Number(x) => text.push_str(&number_text(*x)),
        Value::Text(words) => write_text(text, words),
        Value::List(items) => {
            text.push('[');
            for (place, item) in items.iter().enumerate() {
                text.push_str(if place == 0 { "" } else { ", " });
                write_inline(text, item);
            }
            text.push(']');
        }
        Value::Object(members) => {
            text.push('{');
            for (place, (key, item)) in members.iter().enumerate() {
                text.push_str(if place == 0 { "" } else { ", " });
                write_text(text, key);
                text.push_str(": ");
                write_inline(text, item);
            }
            text.push('}');
        }
    }
}

fn write_text(text: &mut String, words: &str) {
    text.push('"');
    for c in words.chars() {
        match c {
            '"' => text.push_str("\\\""),
            '\\' => text.push_str("\\\\"),
            '\n' => text.push_str("\\n"),
            '\r' => text.push_str("\\r"),
            '\t' => text.push_str("\\t"),
            c if (c as u32) < 0x20 => text.push_str(&format!("\\u{:04x}", c as u32)),
            c => text.push(c),
        }
    }
    text.push('"');
}

fn pad(text: &mut String, indent: usize) {
    for _ in 0..indent {
        text.push_str("  ");
    }
}
