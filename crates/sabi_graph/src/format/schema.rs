//! The JSON schema of graph files.

use super::{Key, OBJECTS, ObjectKeys, Shape};
use crate::Value;
use crate::layout::{Item, OrderedObject};
use crate::migrate::NEWEST;

/// Object of a graph file with its keys, for documentation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormatObject {
    /// Name of the object, as in the schema.
    pub name: &'static str,
    /// Description, a sentence.
    pub about: &'static str,
    /// Keys, in the order of writing.
    pub keys: Vec<FormatKey>,
}

/// Key of an object of a graph file, for documentation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormatKey {
    /// The key.
    pub name: &'static str,
    /// Description of the value.
    pub value: String,
    /// True if the object must have it.
    pub is_needed: bool,
    /// Meaning, a sentence.
    pub about: &'static str,
}

/// Lists the objects of a graph file, the file itself first.
pub fn format_objects() -> Vec<FormatObject> {
    let key = |key: &Key| FormatKey {
        name: key.name,
        value: words(&key.value),
        is_needed: key.is_needed,
        about: key.about,
    };
    let object = |object: &&ObjectKeys| FormatObject {
        name: object.name,
        about: object.about,
        keys: object.keys.iter().map(key).collect(),
    };
    OBJECTS.iter().map(object).collect()
}

/// Describes a shape in words.
fn words(shape: &Shape) -> String {
    match shape {
        Shape::Word(word) => format!("`\"{word}\"`"),
        Shape::Words(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("`\"{word}\"`")).collect();
            words.join(", ")
        }
        Shape::Text | Shape::Reference => "text".to_owned(),
        Shape::Texts | Shape::References => "list of texts".to_owned(),
        Shape::Flag => "true or false".to_owned(),
        Shape::Whole | Shape::Version => "whole number".to_owned(),
        Shape::Number => "number".to_owned(),
        Shape::Numbers(count) => format!("list of {count} numbers"),
        Shape::Fit => "text or number".to_owned(),
        Shape::Any => "any".to_owned(),
        Shape::Curve => "list of points".to_owned(),
        Shape::Object(keys) => format!("object: {}", keys.name),
        Shape::Objects(keys) => format!("object by name: {}", keys.name),
        Shape::Map(of) => format!("object by name: {}", words(of)),
    }
}

/// Returns the JSON schema (draft 2020-12) of graph files, as text. It allows keys that it does not name, since saving keeps unknown keys.
pub fn format_schema() -> String {
    let mut schema = OrderedObject::default();
    schema.put("$schema", "https://json-schema.org/draft/2020-12/schema");
    schema.put("title", "Sabi graph");
    schema.put(
        "description",
        "A graph file (.sabi). Other keys than those named here are kept when it is saved, and have no effect.",
    );
    schema.put("$ref", reference(OBJECTS[0]));
    let mut defined = OrderedObject::default();
    for object in OBJECTS {
        defined.put_object(object.name, object_schema(object));
    }
    schema.put_object("$defs", defined);
    schema.into_text()
}

fn reference(object: &ObjectKeys) -> String {
    format!("#/$defs/{}", object.name)
}

fn object_schema(object: &ObjectKeys) -> OrderedObject {
    let mut schema = OrderedObject::default();
    schema.put("description", object.about);
    schema.put("type", "object");
    let needed: Vec<&str> = object
        .keys
        .iter()
        .filter(|key| key.is_needed)
        .map(|key| key.name)
        .collect();
    schema.put_some("required", Some(needed).filter(|needed| !needed.is_empty()));
    let mut properties = OrderedObject::default();
    for key in object.keys {
        let mut property = shape_schema(&key.value);
        property.put("description", key.about);
        properties.put_object(key.name, property);
    }
    schema.put_object("properties", properties);
    schema
}

fn shape_schema(shape: &Shape) -> OrderedObject {
    let mut schema = OrderedObject::default();
    match shape {
        Shape::Word(word) => schema.put("const", *word),
        Shape::Words(words) => schema.put("enum", words.to_vec()),
        Shape::Text => schema.put("type", "string"),
        Shape::Reference => {
            schema.put("type", "string");
            schema.put("pattern", "^[a-z0-9_]{1,64}(\\.[^./]{1,64})?$");
        }
        Shape::Texts => list(&mut schema, shape_schema(&Shape::Text)),
        Shape::References => {
            let mut slot = shape_schema(&Shape::Text);
            slot.put("pattern", "^[a-z0-9_]{1,64}\\.[^./]{1,64}$");
            list(&mut schema, slot);
        }
        Shape::Flag => schema.put("type", "boolean"),
        Shape::Whole => whole(&mut schema, u32::MAX),
        Shape::Version => schema.put("const", NEWEST),
        Shape::Number => schema.put("type", "number"),
        Shape::Numbers(count) => {
            list(&mut schema, shape_schema(&Shape::Number));
            let count = *count as u32;
            schema.put("minItems", count);
            schema.put("maxItems", count);
        }
        Shape::Fit => {
            let words = Value::Object([("enum".to_owned(), vec!["unit", "metres", "piece"].into())].into());
            let length = [("type", "number".into()), ("exclusiveMinimum", 0u32.into())];
            let length = Value::Object(length.map(|(key, value)| (key.to_owned(), value)).into());
            schema.put("anyOf", Value::List(vec![words, length]));
        }
        Shape::Any => {}
        Shape::Curve => {
            list(&mut schema, shape_schema(&Shape::Numbers(2)));
            schema.put("minItems", 2u32);
        }
        Shape::Object(keys) => schema.put("$ref", reference(keys)),
        Shape::Objects(keys) => by_name(&mut schema, shape_schema(&Shape::Object(keys))),
        Shape::Map(of) => by_name(&mut schema, shape_schema(of)),
    }
    schema
}

fn by_name(schema: &mut OrderedObject, values: OrderedObject) {
    schema.put("type", "object");
    schema.put_object("additionalProperties", values);
}

fn list(schema: &mut OrderedObject, items: OrderedObject) {
    schema.put("type", "array");
    schema.push("items".to_owned(), Item::Object(items));
}

fn whole(schema: &mut OrderedObject, highest: u32) {
    schema.put("type", "integer");
    schema.put("minimum", 0u32);
    schema.put("maximum", highest);
}
