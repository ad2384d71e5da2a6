//! The JSON schema of graph files.

use super::{OBJECTS, ObjectKey, ObjectKeys, ValueShape};
use crate::Value;
use crate::layout::{LayoutItem, OrderedObject};
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
    let key = |key: &ObjectKey| FormatKey {
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
fn words(shape: &ValueShape) -> String {
    match shape {
        ValueShape::Word(word) => format!("`\"{word}\"`"),
        ValueShape::Words(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("`\"{word}\"`")).collect();
            words.join(", ")
        }
        ValueShape::Text | ValueShape::Reference => "text".to_owned(),
        ValueShape::Texts | ValueShape::References => "list of texts".to_owned(),
        ValueShape::Flag => "true or false".to_owned(),
        ValueShape::Whole | ValueShape::Version => "whole number".to_owned(),
        ValueShape::Number => "number".to_owned(),
        ValueShape::Numbers(count) => format!("list of {count} numbers"),
        ValueShape::Fit => "text or number".to_owned(),
        ValueShape::Any => "any".to_owned(),
        ValueShape::Curve => "list of points".to_owned(),
        ValueShape::Object(keys) => format!("object: {}", keys.name),
        ValueShape::Objects(keys) => format!("object by name: {}", keys.name),
        ValueShape::Map(of) => format!("object by name: {}", words(of)),
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

fn shape_schema(shape: &ValueShape) -> OrderedObject {
    let mut schema = OrderedObject::default();
    match shape {
        ValueShape::Word(word) => schema.put("const", *word),
        ValueShape::Words(words) => schema.put("enum", words.to_vec()),
        ValueShape::Text => schema.put("type", "string"),
        ValueShape::Reference => {
            schema.put("type", "string");
            schema.put("pattern", "^[a-z0-9_]{1,64}(\\.[^./]{1,64})?$");
        }
        ValueShape::Texts => list(&mut schema, shape_schema(&ValueShape::Text)),
        ValueShape::References => {
            let mut slot = shape_schema(&ValueShape::Text);
            slot.put("pattern", "^[a-z0-9_]{1,64}\\.[^./]{1,64}$");
            list(&mut schema, slot);
        }
        ValueShape::Flag => schema.put("type", "boolean"),
        ValueShape::Whole => whole(&mut schema, u32::MAX),
        ValueShape::Version => schema.put("const", NEWEST),
        ValueShape::Number => schema.put("type", "number"),
        ValueShape::Numbers(count) => {
            list(&mut schema, shape_schema(&ValueShape::Number));
            let count = *count as u32;
            schema.put("minItems", count);
            schema.put("maxItems", count);
        }
        ValueShape::Fit => {
            let words = Value::Object([("enum".to_owned(), vec!["unit", "metres", "piece"].into())].into());
            let length = [("type", "number".into()), ("exclusiveMinimum", 0u32.into())];
            let length = Value::Object(length.map(|(key, value)| (key.to_owned(), value)).into());
            schema.put("anyOf", Value::List(vec![words, length]));
        }
        ValueShape::Any => {}
        ValueShape::Curve => {
            list(&mut schema, shape_schema(&ValueShape::Numbers(2)));
            schema.put("minItems", 2u32);
        }
        ValueShape::Object(keys) => schema.put("$ref", reference(keys)),
        ValueShape::Objects(keys) => by_name(&mut schema, shape_schema(&ValueShape::Object(keys))),
        ValueShape::Map(of) => by_name(&mut schema, shape_schema(of)),
    }
    schema
}

fn by_name(schema: &mut OrderedObject, values: OrderedObject) {
    schema.put("type", "object");
    schema.put_object("additionalProperties", values);
}

fn list(schema: &mut OrderedObject, items: OrderedObject) {
    schema.put("type", "array");
    schema.push("items".to_owned(), LayoutItem::Object(items));
}

fn whole(schema: &mut OrderedObject, highest: u32) {
    schema.put("type", "integer");
    schema.put("minimum", 0u32);
    schema.put("maximum", highest);
}
