//! Tables of a matrix: the axes whose product is baked.

use std::cell::Cell;
use std::rc::Rc;

use glob::Pattern;
use sabi_engine::baking::DEFAULT_PRESET;
use sabi_engine::opening::add_values;
use sabi_graph::{Value, nearest};
use serde_json::Value as Json;
use toml::{Table, Value as Toml};

use crate::options::{ItemOptions, check_option, option_names};

const DEFAULT_SIZE: u32 = 1024;
/// Number of faults after which a matrix is read no further. It is more than an error shows.
pub(crate) const MOST_FAULTS: usize = 1000;

const KEYS: [&str; 11] = [
    "exclude", "graphs", "models", "name", "out", "presets", "seed", "set", "set_file", "sizes", "variants",
];

/// A `[[bake]]` table, or the defaults of all.
#[derive(Clone, Debug)]
pub(crate) struct MatrixRow {
    /// Words for it in messages.
    pub(crate) words: String,
    /// Its name.
    pub(crate) name: Option<String>,
    /// Paths of models, with `*` and `?`.
    pub(crate) models: Vec<String>,
    /// Paths of graphs, with `*` and `?`.
    pub(crate) graphs: Vec<String>,
    /// Variants; empty for the graph's own values.
    pub(crate) variants: Vec<VariantChoice>,
    /// Seeds; empty for that of the graph.
    pub(crate) seeds: Vec<SeedChoice>,
    /// Texels along a side of the maps.
    pub(crate) sizes: Vec<u32>,
    /// Presets. Those of an inner list are baked together.
    pub(crate) presets: Vec<Vec<String>>,
    /// Values by knob or `node.param`. Later values override earlier ones.
    pub(crate) set: Vec<(String, Value)>,
    /// Files of values, which are overridden by the table's own values.
    pub(crate) set_files: Vec<String>,
    /// Other options.
    pub(crate) options: ItemOptions,
    /// Pattern of folders.
    pub(crate) out: Option<String>,
    /// Items that are left out.
    pub(crate) exclusions: Vec<Exclusion>,
}

/// Variant of a graph, with values on top of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct VariantChoice {
    /// Name in folder names; `None` for the name of the variant.
    pub(crate) name: Option<String>,
    /// Variant, or a pattern for several; `None` for the graph's own values.
    pub(crate) variant: Option<String>,
    /// Values on top of all others.
    pub(crate) set: Vec<(String, Value)>,
}

/// Seed of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SeedChoice {
    Number(u32),
    /// A seed for each model, computed from its path.
    PerModel,
}

/// Condition for leaving out items: those to which all parts of it apply.
#[derive(Clone, Debug)]
pub(crate) struct Exclusion {
    pub(crate) conditions: Vec<(ExclusionKey, Condition)>,
    /// True once it has left out an item. A condition of the defaults may have done so in any table.
    pub(crate) is_used: Rc<Cell<bool>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ExclusionKey {
    Graph,
    Model,
    Preset,
    Seed,
    Size,
    Variant,
}

#[derive(Clone, Debug)]
pub(crate) enum Condition {
    Number(u32),
    Text(Pattern),
}

const EXCLUSION_KEYS: [(&str, ExclusionKey); 6] = [
    ("graph", ExclusionKey::Graph),
    ("model", ExclusionKey::Model),
    ("preset", ExclusionKey::Preset),
    ("seed", ExclusionKey::Seed),
    ("size", ExclusionKey::Size),
    ("variant", ExclusionKey::Variant),
];

impl MatrixRow {
    pub(crate) fn new(words: &str) -> MatrixRow {
        MatrixRow {
            words: words.to_owned(),
            name: None,
            models: Vec::new(),
            graphs: Vec::new(),
            variants: Vec::new(),
            seeds: Vec::new(),
            sizes: vec![DEFAULT_SIZE],
            presets: vec![vec![DEFAULT_PRESET.to_owned()]],
            set: Vec::new(),
            set_files: Vec::new(),
            options: ItemOptions::new(),
            out: None,
            exclusions: Vec::new(),
        }
    }

    /// Reads a `[[bake]]` table with this index.
    pub(crate) fn read(values: Table, index: usize, defaults: &MatrixRow) -> Result<MatrixRow, Vec<String>> {
        let mut row = defaults.clone();
        row.words = match values.get("name").and_then(Toml::as_str) {
            Some(name) => format!("bake '{name}'"),
            None => format!("bake {}", index + 1),
        };
        row.take_all(values)?;
        let lacks = |what: &str, example: &str| {
            format!(
                "{}: there are no {what}; write {what} = \"{example}\", or a list",
                row.words
            )
        };
        let missing = [
            row.models.is_empty().then(|| lacks("models", "model.glb")),
            row.graphs.is_empty().then(|| lacks("graphs", "graph.sabi")),
        ];
        let missing: Vec<String> = missing.into_iter().flatten().collect();
        if missing.is_empty() { Ok(row) } else { Err(missing) }
    }

    /// Takes all values of a table.
    pub(crate) fn take_all(&mut self, values: Table) -> Result<(), Vec<String>> {
        let mut faults = Vec::new();
        for (key, value) in values {
            if let Err(clauses) = self.take(&key, value) {
                faults.extend(clauses.into_iter().map(|why| format!("{}: {why}", self.words)));
            }
            if faults.len() >= MOST_FAULTS {
                break;
            }
        }
        match faults.is_empty() {
            true => Ok(()),
            false => Err(faults),
        }
    }

    /// Sets a value for a key, in place of the default. The errors are clauses.
    pub(crate) fn take(&mut self, key: &str, value: Toml) -> Result<(), Vec<String>> {
        match (key, value) {
            ("set", Toml::Table(values)) => {
                let faults = add_values(&mut self.set, "", values);
                if faults.is_empty() { Ok(()) } else { Err(faults) }
            }
            ("exclude", value) => {
                self.exclusions = exclusions(value)?;
                Ok(())
            }
            (_, value) => self.take_plain(key, value).map_err(|why| vec![why]),
        }
    }

    /// Sets a value that can have at most one fault.
    fn take_plain(&mut self, key: &str, value: Toml) -> Result<(), String> {
        match key {
            "name" if self.words == "defaults" => return Err("only a [[bake]] has a name".to_owned()),
            "name" => self.name = Some(text(key, &value, "a text")?),
            "out" => self.out = Some(text(key, &value, "a pattern for folders, as a text")?),
            "models" => self.models = list(key, value, "the path of a model, or a list of paths", as_text)?,
            "graphs" => self.graphs = list(key, value, "the path of a graph, or a list of paths", as_text)?,
            "set_file" => {
                self.set_files = list(key, value, "the path of a file of values, or a list of paths", as_text)?
            }
            "sizes" => {
                self.sizes = list(
                    key,
                    value,
                    "a whole number from 16 to 8192, or a list of these",
                    as_size,
                )?
            }
            "seed" => {
                let takes = format!(
                    "\"per model\", a whole number from 0 to {}, or a list of these",
                    u32::MAX
                );
                self.seeds = list(key, value, &takes, as_seed)?;
            }
            "presets" => {
                let takes = "the name of a preset or the path of its file, or a list of these; presets in an inner list are \
                             baked together";
                self.presets = list(key, value, takes, as_presets)?;
            }
            "variants" => {
                let takes = "the name of a variant, a table with name, variant and set, or a list of these";
                self.variants = list(key, value, takes, |value| Some(value.clone()))?
                    .into_iter()
                    .map(variant)
                    .collect::<Result<_, _>>()?;
            }
            "set" => return Err("'set' takes a table of values".to_owned()),
            name if option_names().any(|known| known == name) => {
                let value = json(&value);
                check_option(name, &value)?;
                self.options.insert(name.to_owned(), value);
            }
            other => {
                let known = KEYS.into_iter().chain(option_names());
                return Err(match nearest(other, known) {
                    Some(near) => format!("there is no key '{other}'; did you mean '{near}'?"),
                    None => format!("there is no key '{other}'"),
                });
            }
        }
        Ok(())
    }
}

/// Reads tables of conditions.
pub(crate) fn exclusions(value: Toml) -> Result<Vec<Exclusion>, Vec<String>> {
    let takes = "'exclude' takes a list of tables, such as [{ size = 2048, preset = \"gltf\" }]";
    let Toml::Array(tables) = value else {
        return Err(vec![takes.to_owned()]);
    };
    let exclusion = |table: Toml| {
        let Toml::Table(table) = table else {
            return Err(vec![takes.to_owned()]);
        };
        if table.is_empty() {
            return Err(vec![
                "'exclude' has an empty table, which would leave out everything".to_owned(),
            ]);
        }
        let conditions = table
            .into_iter()
            .map(|(key, value)| condition(&key, &value).map_err(|why| vec![why]));
        Ok(Exclusion {
            conditions: all(conditions)?,
            is_used: Rc::new(Cell::new(false)),
        })
    };
    all(tables.into_iter().map(exclusion))
}

/// Collects values, or the faults of all that cannot be read; of very many faults, the first.
pub(crate) fn all<T>(read: impl Iterator<Item = Result<T, Vec<String>>>) -> Result<Vec<T>, Vec<String>> {
    let (mut values, mut faults) = (Vec::new(), Vec::new());
    for read in read {
        match read {
            Ok(value) => values.push(value),
            Err(clauses) => faults.extend(clauses),
        }
        if faults.len() >= MOST_FAULTS {
            break;
        }
    }
    if faults.is_empty() { Ok(values) } else { Err(faults) }
}

fn condition(key: &str, value: &Toml) -> Result<(ExclusionKey, Condition), String> {
    let names = EXCLUSION_KEYS.map(|(name, _)| name);
    let Some((_, found)) = EXCLUSION_KEYS.iter().find(|(name, _)| *name == key) else {
        let advice = match nearest(key, names) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("there is: {}", names.join(", ")),
        };
        return Err(format!("'exclude' has no key '{key}'; {advice}"));
    };
    let condition = match (found, value) {
        (ExclusionKey::Seed | ExclusionKey::Size, Toml::Integer(number)) => {
            u32::try_from(*number).ok().map(Condition::Number)
        }
        (ExclusionKey::Seed | ExclusionKey::Size, _) => None,
        (_, Toml::String(text)) => Pattern::new(text).ok().map(Condition::Text),
        _ => None,
    };
    let condition = condition.ok_or_else(|| format!("'exclude' cannot have {value} as {key}"))?;
    Ok((*found, condition))
}

/// Reads one value or a list of them.
fn list<T>(key: &str, value: Toml, takes: &str, read: impl Fn(&Toml) -> Option<T>) -> Result<Vec<T>, String> {
    let values = match value {
        Toml::Array(values) => values,
        value => vec![value],
    };
    if values.is_empty() {
        return Err(format!("'{key}' is an empty list, which bakes nothing"));
    }
    let read: Option<Vec<T>> = values.iter().map(read).collect();
    read.ok_or_else(|| format!("'{key}' takes {takes}"))
}

fn text(key: &str, value: &Toml, takes: &str) -> Result<String, String> {
    as_text(value).ok_or_else(|| format!("'{key}' takes {takes}"))
}

fn as_text(value: &Toml) -> Option<String> {
    value.as_str().filter(|text| !text.trim().is_empty()).map(str::to_owned)
}

fn as_size(value: &Toml) -> Option<u32> {
    let size = u32::try_from(value.as_integer()?).ok()?;
    (16..=8192).contains(&size).then_some(size)
}

fn as_seed(value: &Toml) -> Option<SeedChoice> {
    match value {
        Toml::String(text) if text == "per model" => Some(SeedChoice::PerModel),
        Toml::Integer(seed) => u32::try_from(*seed).ok().map(SeedChoice::Number),
        _ => None,
    }
}

fn as_presets(value: &Toml) -> Option<Vec<String>> {
    match value {
        Toml::Array(names) if !names.is_empty() => names.iter().map(as_text).collect(),
        name => Some(vec![as_text(name)?]),
    }
}

fn variant(value: Toml) -> Result<VariantChoice, String> {
    let name = |text: String| Some(text).filter(|text| !text.is_empty());
    let mut choice = VariantChoice::default();
    let table = match value {
        Toml::String(text) => {
            choice.variant = name(text);
            return Ok(choice);
        }
        Toml::Table(table) => table,
        _ => return Err("'variants' takes names and tables".to_owned()),
    };
    for (key, value) in table {
        match (key.as_str(), value) {
            ("name", Toml::String(text)) => choice.name = name(text),
            ("variant", Toml::String(text)) => choice.variant = name(text),
            ("set", Toml::Table(values)) => {
                let faults = add_values(&mut choice.set, "", values);
                if !faults.is_empty() {
                    return Err(faults.join(", and "));
                }
            }
            (key, _) => {
                return Err(format!(
                    "a table of 'variants' has name and variant, which are texts, and set, which is a table, but no such '{key}'"
                ));
            }
        }
    }
    Ok(choice)
}

/// Converts a TOML value to JSON. Dates become texts, which no option accepts.
fn json(value: &Toml) -> Json {
    match value {
        Toml::String(text) => text.as_str().into(),
        Toml::Integer(whole) => (*whole).into(),
        Toml::Float(number) => (*number).into(),
        Toml::Boolean(yes) => (*yes).into(),
        Toml::Datetime(date) => date.to_string().into(),
        Toml::Array(values) => values.iter().map(json).collect(),
        Toml::Table(values) => values.iter().map(|(key, value)| (key.clone(), json(value))).collect(),
    }
}
