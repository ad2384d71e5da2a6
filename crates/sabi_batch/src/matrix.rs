//! Matrix files: TOML that defines which graphs are baked on which models, with which settings.

use std::path::{Path, PathBuf};

use sabi_engine::opening::toml_file::read_table;
use sabi_engine::{EngineError, ErrorKind};
use sabi_files::PathBase;
use sabi_graph::nearest;
use toml::{Table, Value as Toml};

use crate::matrix_row::{Exclusion, MOST_FAULTS, MatrixRow, all, exclusions};

/// Version of the format.
const VERSION: i64 = 1;

/// Maximum number of items, unless the matrix allows more.
pub(crate) const DEFAULT_LIMIT: usize = 10_000;
/// Maximum number of items that a matrix can allow.
const LARGEST_LIMIT: usize = 100_000;

const KEYS: [&str; 6] = ["bake", "defaults", "exclude", "limit", "out", "version"];

/// A matrix of bakes.
#[derive(Debug)]
pub(crate) struct Matrix {
    /// Its file.
    pub(crate) path: PathBuf,
    /// Most items.
    pub(crate) limit: usize,
    /// Its `[[bake]]` tables, with the defaults.
    pub(crate) rows: Vec<MatrixRow>,
    /// Conditions for leaving out items of any table.
    pub(crate) exclusions: Vec<Exclusion>,
}

impl Matrix {
    /// Reads a matrix.
    ///
    /// # Errors
    /// It cannot be read, is no TOML, or has keys or values that no matrix has.
    pub(crate) fn open(path: &Path) -> Result<Matrix, EngineError> {
        let table = read_table(path, "matrix files")?;
        let said = |faults: Vec<String>| {
            let sentences = faults.into_iter().map(|why| format!("{}: {why}", path.display()));
            EngineError::several(ErrorKind::BadInput, sentences.collect())
        };
        Matrix::of_table(path, table).map_err(said)
    }

    /// Base of the paths in it.
    pub(crate) fn base(&self) -> PathBase {
        PathBase::of_file(&self.path)
    }

    /// Reads the values of a file. The errors are clauses, one for each fault.
    fn of_table(path: &Path, mut table: Table) -> Result<Matrix, Vec<String>> {
        refuse_version(table.get("version")).map_err(|why| vec![why])?;
        let mut faults: Vec<String> = table
            .keys()
            .filter_map(|key| unknown_key(key))
            .take(MOST_FAULTS)
            .collect();
        let mut defaults = MatrixRow::new("defaults");
        if let Some(out) = table.remove("out") {
            faults.extend(defaults.take("out", out).err().into_iter().flatten());
        }
        match table.remove("defaults") {
            None => {}
            Some(Toml::Table(values)) => faults.extend(defaults.take_all(values).err().into_iter().flatten()),
            Some(_) => faults.push("'defaults' takes a table, which begins with [defaults]".to_owned()),
        }
        let limit = limit(table.get("limit")).unwrap_or_else(|why| {
            faults.push(why);
            DEFAULT_LIMIT
        });
        let exclusions = table.remove("exclude").map_or(Ok(Vec::new()), exclusions);
        let exclusions = exclusions.unwrap_or_else(|clauses| {
            faults.extend(clauses);
            Vec::new()
        });
        let row = |(at, row): (usize, Toml)| match row {
            Toml::Table(values) => MatrixRow::read(values, at, &defaults),
            _ => Err(vec![
                "'bake' takes tables, each of which begins with [[bake]]".to_owned(),
            ]),
        };
        let rows = match table.remove("bake") {
            Some(Toml::Array(rows)) => all(rows.into_iter().enumerate().map(row)),
            Some(_) => Err(vec![
                "'bake' takes tables, each of which begins with [[bake]]".to_owned(),
            ]),
            // If there are other faults, the missing key is probably one that is misspelled.
            None if faults.is_empty() => Err(vec!["there is nothing to bake; begin a table with [[bake]]".to_owned()]),
            None => Ok(Vec::new()),
        };
        match rows {
            Ok(rows) if faults.is_empty() => Ok(Matrix {
                path: path.to_owned(),
                limit,
                rows,
                exclusions,
            }),
            rows => {
                faults.extend(rows.err().into_iter().flatten());
                Err(faults)
            }
        }
    }
}

/// Refuses a matrix of another version; the error is a clause.
fn refuse_version(version: Option<&Toml>) -> Result<(), String> {
    match version {
        Some(Toml::Integer(VERSION)) => Ok(()),
        Some(other) => Err(format!(
            "version {other} of matrix files is not known; this Sabi reads {VERSION}"
        )),
        None => Err(format!("there is no version; begin with version = {VERSION}")),
    }
}

/// Returns a clause about a key that a matrix cannot have.
fn unknown_key(key: &str) -> Option<String> {
    let advice = match nearest(key, KEYS) {
        _ if KEYS.contains(&key) => return None,
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("there is: {}", KEYS.join(", ")),
    };
    Some(format!("there is no key '{key}'; {advice}"))
}

fn limit(value: Option<&Toml>) -> Result<usize, String> {
    let Some(value) = value else { return Ok(DEFAULT_LIMIT) };
    let limit = value.as_integer().and_then(|limit| usize::try_from(limit).ok());
    let limit = limit.filter(|limit| (1..=LARGEST_LIMIT).contains(limit));
    limit.ok_or_else(|| format!("'limit' takes a whole number from 1 to {LARGEST_LIMIT}, not {value}"))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::Matrix;

    fn read(text: &str) -> Result<Matrix, String> {
        Matrix::of_table(Path::new("m.toml"), text.parse().expect("TOML")).map_err(|faults| faults.join("; "))
    }

    #[test]
    fn a_table_uses_the_defaults_for_keys_that_it_does_not_set() {
        let text = "version = 1\nout = \"o/$mesh\"\n[defaults]\ngraphs = \"a.sabi\"\nsizes = [64, 128]\nset = { a = 1 }\nup = \"z\"\n\
            [[bake]]\nmodels = \"a.glb\"\n[[bake]]\nname = \"b\"\nmodels = [\"b*.glb\"]\nsizes = 32\nset = { b = 2 }\nup = \"y\"\n";
        let matrix = read(text).expect("a matrix");
        let [first, second] = &matrix.rows[..] else {
            panic!("two rows")
        };
        assert_eq!((&first.sizes[..], &second.sizes[..]), (&[64, 128][..], &[32][..]));
        assert_eq!((first.set.len(), second.set.len()), (1, 2), "values add up");
        assert_eq!(first.options["up"], "z");
        assert_eq!(second.options["up"], "y");
        assert_eq!((first.words.as_str(), second.words.as_str()), ("bake 1", "bake 'b'"));
    }

    /// Invalid matrices, each with the error.
    const REFUSED: [(&str, &str); 18] = [
        ("[[bake]]", "there is no version; begin with version = 1"),
        (
            "version = 2",
            "version 2 of matrix files is not known; this Sabi reads 1",
        ),
        ("version = 1", "there is nothing to bake; begin a table with [[bake]]"),
        (
            "version = 1\nbakes = 1",
            "there is no key 'bakes'; did you mean 'bake'?",
        ),
        (
            "version = 1\nlimit = 0\nbake = []",
            "'limit' takes a whole number from 1 to 100000, not 0",
        ),
        (
            "version = 1\n[[bake]]\ngraphs = \"a\"",
            "bake 1: there are no models; write models = \"model.glb\", or a list",
        ),
        (
            "version = 1\n[[bake]]\nmodels = \"a\"",
            "bake 1: there are no graphs; write graphs = \"graph.sabi\", or a list",
        ),
        (
            "version = 1\n[[bake]]\nmodels = \"a\"\ngraphs = []",
            "bake 1: 'graphs' is an empty list, which bakes nothing",
        ),
        (
            "version = 1\n[[bake]]\nmodls = \"a\"",
            "bake 1: there is no key 'modls'; did you mean 'models'?",
        ),
        (
            "version = 1\n[[bake]]\nname = \"x\"\nseed = -1",
            "bake 'x': 'seed' takes \"per model\", a whole number from 0 to 4294967295, or a list of these",
        ),
        (
            "version = 1\n[[bake]]\nseed = [1, \"each\"]",
            "bake 1: 'seed' takes \"per model\", a whole number from 0 to 4294967295, or a list of these",
        ),
        (
            "version = 1\n[[bake]]\nsizes = [64, 15]",
            "bake 1: 'sizes' takes a whole number from 16 to 8192, or a list of these",
        ),
        (
            "version = 1\n[[bake]]\npadding = \"x\"",
            "bake 1: 'padding' takes 0 to 8192 texels, or 'infinite', not \"x\"",
        ),
        (
            "version = 1\n[defaults]\nname = \"x\"\n[[bake]]\nmodels = \"a\"\ngraphs = \"b\"",
            "defaults: only a [[bake]] has a name",
        ),
        (
            "version = 1\nexclude = [{ sizes = 64 }]\n[[bake]]\nmodels = \"a\"\ngraphs = \"b\"",
            "'exclude' has no key 'sizes'; did you mean 'size'?",
        ),
        (
            "version = 1\nexclude = [{}]\n[[bake]]\nmodels = \"a\"\ngraphs = \"b\"",
            "'exclude' has an empty table, which would leave out everything",
        ),
        (
            "version = 1\nlimit = 0\n[[bake]]\nsizes = 1\nset = { a = nan, b = inf }\n[[bake]]\nname = \"x\"",
            "'limit' takes a whole number from 1 to 100000, not 0; bake 1: 'sizes' takes a whole number from 16 to \
             8192, or a list of these; bake 1: 'a' is no finite number; bake 1: 'b' is no finite number; bake 'x': there are no models; write \
             models = \"model.glb\", or a list; bake 'x': there are no graphs; write graphs = \"graph.sabi\", or a list",
        ),
        (
            "version = 1\nexclude = [{ sizes = 64 }, { graphs = 1 }]\n[[bake]]\nmodels = \"a\"\ngraphs = \"b\"",
            "'exclude' has no key 'sizes'; did you mean 'size'?; 'exclude' has no key 'graphs'; did you mean 'graph'?",
        ),
    ];

    #[test]
    fn a_matrix_with_very_many_unknown_keys_is_refused_after_the_first() {
        let keys: String = (0..200_000).map(|at| format!("a{at} = 1\n")).collect();
        let tables = "[[bake]]\nmodls = 1\n".repeat(100_000);
        for text in [
            format!("version = 1\n{keys}"),
            format!("version = 1\n[defaults]\n{keys}"),
            format!("version = 1\n{tables}"),
        ] {
            let faults = Matrix::of_table(Path::new("m.toml"), text.parse().expect("TOML")).expect_err("faults");
            assert!((1000..1010).contains(&faults.len()), "{}", faults.len());
        }
    }

    #[test]
    fn keys_and_values_that_no_matrix_can_have_are_refused_by_name() {
        for (text, why) in REFUSED {
            assert_eq!(read(text).map(drop), Err(why.to_owned()), "{text}");
        }
    }
}
