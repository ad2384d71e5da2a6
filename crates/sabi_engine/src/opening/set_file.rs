//! Files of values for a graph: TOML with a variant, a seed, and a table of values by knob or `node.param`.

use std::path::Path;

use sabi_graph::{Value, nearest};
use toml::{Table, Value as Toml};

use crate::error::{EngineError, ErrorKind};
use crate::opening::toml_file::read_table;

const KEYS: [&str; 3] = ["seed", "set", "variant"];

/// Values from a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetFile {
    /// Variant to start from.
    pub variant: Option<String>,
    /// Seed in place of the graph's.
    pub seed: Option<u32>,
    /// Values by exposed knob or `node.param`, in the order of the file. A text is parsed by the type of the parameter, as
    /// by [`read_setting`](crate::opening::read_setting).
    pub set: Vec<(String, Value)>,
}

impl SetFile {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, is no TOML, or has keys or values of other sorts. Whether a graph has what it sets is not known here.
    pub fn open(path: &Path) -> Result<SetFile, EngineError> {
        let table = read_table(path, "files of values")?;
        let said = |faults: Vec<String>| {
            let sentences = faults.into_iter().map(|why| format!("{}: {why}", path.display()));
            EngineError::several(ErrorKind::BadInput, sentences.collect())
        };
        SetFile::of_table(table).map_err(said)
    }

    /// Reads the values of a file. The errors are clauses, one for each fault.
    fn of_table(table: Table) -> Result<SetFile, Vec<String>> {
        let mut file = SetFile::default();
        let mut faults = Vec::new();
        for (key, value) in table {
            match (key.as_str(), value) {
                ("variant", Toml::String(name)) => file.variant = Some(name),
                ("variant", _) => faults.push("'variant' takes the name of a variant, as a text".to_owned()),
                ("seed", Toml::Integer(seed)) if u32::try_from(seed).is_ok() => file.seed = u32::try_from(seed).ok(),
                ("seed", _) => faults.push(format!("'seed' takes a whole number from 0 to {}", u32::MAX)),
                ("set", Toml::Table(values)) => faults.extend(add_values(&mut file.set, "", values)),
                ("set", _) => faults.push("'set' takes a table of values, which begins with [set]".to_owned()),
                (key, _) => faults.push(unknown_key(key)),
            }
        }
        match faults.is_empty() {
            true => Ok(file),
            false => Err(faults),
        }
    }
}

fn unknown_key(key: &str) -> String {
    match nearest(key, KEYS) {
        Some(near) => format!("there is no key '{key}'; did you mean '{near}'?"),
        None => format!("there is no key '{key}' besides variant, seed and set; values stand below [set]"),
    }
}

/// Adds the values of a table. Returns a clause for each value that no parameter could accept. Without quotes, `node.param
/// = 1` is a table in a table.
pub fn add_values(set: &mut Vec<(String, Value)>, prefix: &str, values: Table) -> Vec<String> {
    let mut faults = Vec::new();
    for (key, value) in values {
        let name = format!("{prefix}{key}");
        match value {
            Toml::Table(inner) => faults.extend(add_values(set, &format!("{name}."), inner)),
            value => match read_value(value) {
                Ok(value) => set.push((name, value)),
                Err(why) => faults.push(format!("'{name}' {why}")),
            },
        }
    }
    faults
}

fn read_value(value: Toml) -> Result<Value, &'static str> {
    Ok(match value {
        Toml::String(text) => Value::Text(text),
        Toml::Integer(whole) => Value::Number(whole as f64),
        Toml::Float(number) if number.is_finite() => Value::Number(number),
        Toml::Float(_) => return Err("is no finite number"),
        Toml::Boolean(yes) => Value::Bool(yes),
        Toml::Array(items) => Value::List(items.into_iter().map(read_value).collect::<Result<_, _>>()?),
        Toml::Datetime(_) => return Err("is a date, which nothing takes; write a text in quotes"),
        Toml::Table(_) => return Err("has a table in its list, which nothing takes"),
    })
}

#[cfg(test)]
mod tests {
    use sabi_graph::Value;

    use super::SetFile;

    fn read(text: &str) -> Result<SetFile, String> {
        SetFile::of_table(text.parse().unwrap()).map_err(|faults| faults.join("; "))
    }

    #[test]
    fn values_keep_their_types_and_their_order() {
        let text = "variant = \"heavy\"\nseed = 7\n[set]\nwear = 0.5\nclouds.octaves = 3\n\"base.color\" = \"#6b3a1e\"\n\
            direction = [0, 1.5, 0]\n[set.stain]\nmuted = true\n";
        let number = Value::Number;
        let set = [
            ("wear", number(0.5)),
            ("clouds.octaves", number(3.0)),
            ("base.color", Value::Text("#6b3a1e".to_owned())),
            ("direction", Value::List([0.0, 1.5, 0.0].map(number).to_vec())),
            ("stain.muted", Value::Bool(true)),
        ];
        let expected = SetFile {
            variant: Some("heavy".to_owned()),
            seed: Some(7),
            set: set.map(|(name, value)| (name.to_owned(), value)).to_vec(),
        };
        assert_eq!(read(text), Ok(expected));
    }

    #[test]
    fn values_that_no_graph_could_accept_are_refused_by_name() {
        let cases = [
            ("varient = \"x\"", "there is no key 'varient'; did you mean 'variant'?"),
            (
                "wear = 1",
                "there is no key 'wear' besides variant, seed and set; values stand below [set]",
            ),
            ("variant = 1", "'variant' takes the name of a variant, as a text"),
            ("seed = -1", "'seed' takes a whole number from 0 to 4294967295"),
            ("seed = 1.0", "'seed' takes a whole number from 0 to 4294967295"),
            ("set = 1", "'set' takes a table of values, which begins with [set]"),
            (
                "seed = -1\nvarient = \"x\"\n[set]\na = nan\nb = inf",
                "'seed' takes a whole number from 0 to 4294967295; there is no key 'varient'; did you mean 'variant'?; 'a' is no \
                 finite number; 'b' is no finite number",
            ),
            ("[set]\na = nan", "'a' is no finite number"),
            (
                "[set]\na.b = 2000-01-01",
                "'a.b' is a date, which nothing takes; write a text in quotes",
            ),
            (
                "[set]\na = [{ b = 1 }]",
                "'a' has a table in its list, which nothing takes",
            ),
        ];
        for (text, why) in cases {
            assert_eq!(read(text), Err(why.to_owned()), "{text}");
        }
    }
}
