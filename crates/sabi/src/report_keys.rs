//! JSON that Sabi writes: docs/report.md lists exactly its keys, and docs/report.schema.json is the schema of it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use sabi_batch::BakeItem;
use sabi_engine::baking::BakeReport;
use sabi_engine::baking::preset_description::PresetDescription;
use sabi_engine::baking::recorded::Verification;
use sabi_engine::catalog::check::CheckedGraph;
use sabi_engine::catalog::description::NodeDescription;
use sabi_engine::catalog::diagnosis::Diagnosis;
use sabi_engine::graph_info::GraphDescription;
use sabi_engine::opening::mesh_report::MeshReport;
use sabi_engine::opening::stroke_report::StrokeReport;
use sabi_engine::packing::{PackReport, UnpackReport};
use sabi_engine::stroke_maintenance::{FlattenReport, ReprojectReport};
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Value as Json, json};

use crate::commands::presets::PresetListing;
use crate::commands::run::summary::Summary;
use crate::event::Event;
use crate::failure_report::{FailedBakeReport, FailedCommandReport};

/// Keys by path, such as `mesh.overlap.materials[].texels`, with the words for their values in docs/report.md.
type Keys = BTreeMap<String, BTreeSet<String>>;

/// JSON that a section of docs/report.md describes.
struct Report {
    section: &'static str,
    schema: Schema,
    /// Path of an object whose keys another section lists.
    elsewhere: Option<&'static str>,
}

impl Report {
    fn of<T: JsonSchema>(section: &'static str, generator: &mut SchemaGenerator) -> Report {
        Report {
            section,
            schema: generator.subschema_for::<T>(),
            elsewhere: None,
        }
    }

    fn with_object_of_another_section(self, path: &'static str) -> Report {
        Report {
            elsewhere: Some(path),
            ..self
        }
    }

    /// Returns the name of the schema, which is the anchor of the section.
    fn name(&self) -> String {
        self.section.to_lowercase().replace(' ', "-")
    }

    /// Returns the keys that the section has to list.
    fn keys(&self, document: &Json) -> Keys {
        let mut keys = Keys::new();
        add_keys("", document, self.schema.as_value(), &mut keys);
        if let Some(path) = self.elsewhere {
            keys.retain(|key, _| !key.starts_with(&format!("{path}.")));
        }
        keys
    }
}

fn reports(generator: &mut SchemaGenerator) -> Vec<Report> {
    let plan = Report::of::<BakeItem>("Line of a plan", generator);
    let presets = Report::of::<Vec<PresetListing>>("List of presets", generator);
    vec![
        Report::of::<BakeReport>("Report of a bake", generator),
        Report::of::<FailedBakeReport>("Report of a failed bake", generator),
        Report::of::<FailedCommandReport>("Failure", generator),
        Report::of::<Vec<Verification>>("Verified folders", generator),
        Report::of::<Event>("Progress", generator),
        plan.with_object_of_another_section("recipe"),
        Report::of::<Summary>("Summary of a run", generator),
        Report::of::<Vec<NodeDescription>>("Nodes", generator),
        Report::of::<MeshReport>("Model", generator),
        Report::of::<Diagnosis>("Machine", generator),
        Report::of::<GraphDescription>("Graph", generator),
        Report::of::<Vec<CheckedGraph>>("Checked graphs", generator),
        Report::of::<PackReport>("Packed graph", generator),
        Report::of::<UnpackReport>("Unpacked graph", generator),
        Report::of::<PresetDescription>("Presets", generator),
        presets.with_object_of_another_section("[].preset"),
        Report::of::<StrokeReport>("Strokes", generator),
        Report::of::<FlattenReport>("Flattened strokes", generator),
        Report::of::<ReprojectReport>("Reprojected strokes", generator),
    ]
}

/// Puts a doc comment on one line, and replaces Rust's word for a missing value by that of JSON.
fn edit_description(schema: &mut Schema) {
    if let Some(Json::String(description)) = schema.get_mut("description") {
        *description = description.replace('\n', " ").replace("`None`", "null");
    }
}

fn generator() -> SchemaGenerator {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    settings
        .with_transform(RecursiveTransform(edit_description))
        .into_generator()
}

/// Returns the schema of all reports.
fn document(reports: &[Report], mut generator: SchemaGenerator) -> Json {
    let mut defined = serde_json::Map::new();
    for report in reports {
        let mut schema = report.schema.clone();
        schema.insert("title".to_owned(), report.section.into());
        defined.insert(report.name(), schema.into());
    }
    let any: Vec<Json> = defined
        .keys()
        .map(|name| json!({ "$ref": format!("#/$defs/{name}") }))
        .collect();
    defined.extend(generator.take_definitions(true));
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "JSON that Sabi writes",
        "description": "A document that report.md describes. Each is defined under the name of its section there.",
        "anyOf": any,
        "$defs": defined,
    })
}

/// Returns the schemas that a value may follow, without references.
fn alternatives<'s>(document: &'s Json, schema: &'s Json) -> Vec<&'s Json> {
    if let Some(path) = schema["$ref"].as_str() {
        let defined = document
            .pointer(path.trim_start_matches('#'))
            .expect("a schema of that name");
        return alternatives(document, defined);
    }
    match schema["anyOf"].as_array().or(schema["oneOf"].as_array()) {
        Some(several) => several.iter().flat_map(|one| alternatives(document, one)).collect(),
        None => vec![schema],
    }
}

/// Adds the keys of the objects that follow a schema.
fn add_keys(path: &str, document: &Json, schema: &Json, keys: &mut Keys) {
    let alternatives = alternatives(document, schema);
    let needs = |object: &Json, key: &str| {
        object["required"]
            .as_array()
            .is_some_and(|all| all.contains(&key.into()))
    };
    for alternative in &alternatives {
        for (key, value) in alternative["properties"].as_object().into_iter().flatten() {
            let is_optional = !alternatives
                .iter()
                .all(|other| other["type"] == "null" || needs(other, key));
            let key = joined(path, key);
            let mut words = words(document, value);
            if is_optional {
                words.remove("null");
                words.insert("optional".to_owned());
            }
            keys.entry(key.clone()).or_default().extend(words);
            add_keys(&key, document, value, keys);
        }
        if let Some(value) = alternative.get("additionalProperties").filter(|value| **value != false) {
            let key = joined(path, "*");
            keys.insert(key.clone(), words(document, value));
            add_keys(&key, document, value, keys);
        }
        if let Some(item) = alternative.get("items") {
            add_keys(&format!("{path}[]"), document, item, keys);
        }
    }
}

fn joined(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_owned()
    } else {
        format!("{path}.{key}")
    }
}

/// Returns the words for the values that follow a schema.
fn words(document: &Json, schema: &Json) -> BTreeSet<String> {
    let types = alternatives(document, schema)
        .into_iter()
        .flat_map(|schema| match &schema["type"] {
            Json::Array(types) => types.iter().filter_map(Json::as_str).collect(),
            one => vec![one.as_str().unwrap_or("any")],
        });
    let words = types.flat_map(|name| match name {
        "string" => vec!["text"],
        "integer" => vec!["number"],
        "boolean" => vec!["true", "false"],
        "array" => vec!["list"],
        other => vec![other],
    });
    words.map(str::to_owned).collect()
}

/// Returns the keys in the table of a section. Those of a map, which are written in capitals, become `*`.
fn documented(section: &str) -> Keys {
    let page = read("report.md");
    let (_, after) = page
        .split_once(&format!("\n## {section}\n"))
        .expect("a section of that title");
    let section = after.split("\n## ").next().expect("the text up to the next section");
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    let keys = rows.map(|row| {
        let (key, row) = row.split_once("` | ").expect("a second column");
        let (value, _) = row.split_once(" | ").expect("a third column");
        let steps = key.split('.').map(|step| match step.chars().all(char::is_uppercase) {
            true => "*",
            false => step,
        });
        let value = value.replace("list of lists", "list");
        let words = value.split([' ', ',']).filter(|word| !["", "or"].contains(word));
        let mut words: BTreeSet<String> = words.map(str::to_owned).collect();
        if words.contains("any") {
            words.remove("null"); // One of its values.
        }
        (steps.collect::<Vec<_>>().join("."), words)
    });
    keys.collect()
}

fn docs(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(file)
}

fn read(file: &str) -> String {
    fs::read_to_string(docs(file)).unwrap_or_default().replace("\r\n", "\n")
}

#[test]
fn the_page_of_reports_lists_exactly_their_keys_with_the_types_of_their_values() {
    let mut generator = generator();
    let reports = reports(&mut generator);
    let document = document(&reports, generator);
    let missing = |keys: &Keys, from: &Keys| -> Vec<String> {
        let missing = keys.iter().filter(|(key, words)| from.get(*key) != Some(words));
        missing.map(|(key, words)| format!("{key}: {words:?}")).collect()
    };
    for report in &reports {
        let (keys, documented) = (report.keys(&document), documented(report.section));
        let faults = [missing(&keys, &documented), missing(&documented, &keys)];
        assert!(
            faults.concat().is_empty(),
            "{}: not on the page, not written: {faults:#?}",
            report.section
        );
    }
    let sections = read("report.md").matches("\n## ").count();
    assert_eq!(sections, reports.len(), "each section describes a report");
}

#[test]
fn the_schema_of_reports_in_the_documentation_is_that_of_the_code() {
    let mut generator = generator();
    let reports = reports(&mut generator);
    let schema = format!("{:#}\n", document(&reports, generator));
    if std::env::var("SABI_BLESS").is_ok_and(|kind| kind == "schema") {
        fs::write(docs("report.schema.json"), &schema).expect("the documentation can be written");
    }
    assert!(
        read("report.schema.json") == schema,
        "docs/report.schema.json is not what the code writes; `cargo xtask bless schema` writes it again"
    );
}
