//! Expansion of a matrix: one draft for each combination of its axes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use glob::Pattern;
use sabi_engine::Kinds;
use sabi_engine::OpenGraph;
use sabi_engine::faults::FaultList;
use sabi_engine::opening::SetFile;
use sabi_engine::phases::{Progress, stop_if_canceled};
use sabi_engine::{EngineError, ErrorKind};
use sabi_files::{PathBase, TrustedPaths};
use sabi_graph::Value;

use crate::matrix::Matrix;
use crate::matrix_row::{Condition, Exclusion, ExclusionKey, MatrixRow, SeedChoice, VariantChoice};
use crate::written_files::{WrittenFile, written_files};

/// Maximum number of values that one item sets. Each of them is looked for in its graph.
const MOST_VALUES: usize = 10_000;
/// Maximum number of values that all items together set. The plan has a text for each.
const MOST_VALUES_OF_ALL: u64 = 4_000_000;

/// A combination of a table of the matrix.
#[derive(Clone, Debug)]
pub(crate) struct Draft<'m> {
    pub(crate) row: &'m MatrixRow,
    pub(crate) graph: WrittenFile,
    pub(crate) model: WrittenFile,
    /// Variant of the graph; `None` for its own values.
    pub(crate) variant: Option<String>,
    /// Name of the variant in folders.
    pub(crate) variant_name: Option<String>,
    pub(crate) seed: Option<u32>,
    pub(crate) set: Vec<(String, Value)>,
    pub(crate) size: u32,
    pub(crate) presets: &'m [String],
}

/// A graph with the kinds of its nodes.
#[derive(Debug)]
pub(crate) struct GraphWithKinds {
    pub(crate) open: OpenGraph,
    pub(crate) kinds: Rc<Kinds>,
}

/// Graphs that have been opened, without repeats.
#[derive(Default)]
pub(crate) struct Graphs {
    graphs: BTreeMap<PathBuf, Result<Rc<GraphWithKinds>, EngineError>>,
    /// Kinds by the folder of the graph.
    kinds: BTreeMap<PathBuf, Rc<Kinds>>,
    /// Paths from which all graphs may open the files that they name.
    trusted: TrustedPaths,
    /// Number of folder entries that were examined for the patterns of the matrix.
    looked_at: usize,
}

impl Graphs {
    pub(crate) fn new(trusted: TrustedPaths) -> Graphs {
        Graphs {
            trusted,
            ..Graphs::default()
        }
    }

    pub(crate) fn trusted(&self) -> &TrustedPaths {
        &self.trusted
    }

    pub(crate) fn open(&mut self, path: &Path) -> Result<Rc<GraphWithKinds>, EngineError> {
        if let Some(known) = self.graphs.get(path) {
            return known.clone();
        }
        let folder = path.parent().unwrap_or(Path::new("")).to_owned(); // A bare file name refers to the current folder.
        let opened = OpenGraph::open_trusting(path, &self.trusted).map(|open| {
            let kinds = self
                .kinds
                .entry(folder)
                .or_insert_with(|| Rc::new(Kinds::beside(Some(path), &open.trusted)));
            let kinds = Rc::clone(kinds);
            Rc::new(GraphWithKinds { open, kinds })
        });
        self.graphs.insert(path.to_owned(), opened.clone());
        opened
    }
}

/// Values that a table sets for all its items.
struct RowValues {
    variant: Option<String>,
    seed: Option<u32>,
    set: Vec<(String, Value)>,
}

/// All combinations of a matrix: models first, presets last, so that items which share work follow each other. Adds faults
/// about missing files and variants, and returns the combinations of all others.
///
/// # Errors
/// There are more items than the matrix allows, or they set very many values, or the work was canceled.
pub(crate) fn expanded<'m>(
    matrix: &'m Matrix,
    graphs: &mut Graphs,
    faults: &mut FaultList,
    progress: &dyn Progress,
) -> Result<Vec<Draft<'m>>, EngineError> {
    let mut drafts = Vec::new();
    let (mut count, mut value_count) = (0u64, 0u64);
    for row in &matrix.rows {
        let expansion = Expansion::of(matrix, row, graphs, faults, progress)?;
        count = count.saturating_add(expansion.count());
        value_count = value_count.saturating_add(expansion.count().saturating_mul(expansion.value_count() as u64));
        if count > matrix.limit as u64 {
            let why = format!(
                "{}: the matrix gives {count} items or more, and its limit is {}; if that is meant, raise 'limit'",
                matrix.path.display(),
                matrix.limit
            );
            return Err(EngineError::new(ErrorKind::BadInput, why));
        }
        if expansion.value_count() > MOST_VALUES || value_count > MOST_VALUES_OF_ALL {
            let why = format!(
                "{}: {}: an item would set {} values, and all items {value_count} or more; an item may set {MOST_VALUES}, and \
                 all items {MOST_VALUES_OF_ALL}; leave out values that are those of the graph",
                matrix.path.display(),
                row.words,
                expansion.value_count()
            );
            return Err(EngineError::new(ErrorKind::BadInput, why));
        }
        expansion.add_to(&mut drafts);
    }
    drafts.retain(|draft| {
        let all = matrix.exclusions.iter().chain(&draft.row.exclusions);
        // All of them are evaluated, not only the first that applies, since each records that it was used.
        let applying = all.filter(|exclusion| exclusion.applies_to(draft)).count();
        applying == 0
    });
    Ok(drafts)
}

/// Axes of a table.
struct Expansion<'m> {
    row: &'m MatrixRow,
    models: Vec<WrittenFile>,
    /// Graphs with their variants.
    graphs: Vec<(WrittenFile, Vec<VariantChoice>)>,
    values: RowValues,
}

impl<'m> Expansion<'m> {
    /// Returns the axes of a table without missing files and variants, which are added to the faults.
    ///
    /// # Errors
    /// The work was canceled.
    fn of(
        matrix: &Matrix,
        row: &'m MatrixRow,
        graphs: &mut Graphs,
        faults: &mut FaultList,
        progress: &dyn Progress,
    ) -> Result<Expansion<'m>, EngineError> {
        let base = matrix.base();
        let said = |why: String| {
            let why = format!("{}: {}: {why}", matrix.path.display(), row.words);
            let canceled = stop_if_canceled(progress).err();
            canceled.unwrap_or_else(|| EngineError::new(ErrorKind::BadInput, why))
        };
        let values = RowValues::of(row, &base, faults);
        let looked_at = &mut graphs.looked_at;
        let mut files = |patterns: &[String]| {
            let mut found: Vec<WrittenFile> = Vec::new();
            let mut known = BTreeSet::new();
            for pattern in patterns {
                let files = written_files(&base, std::slice::from_ref(pattern), looked_at, progress);
                stop_if_canceled(progress)?;
                match files {
                    Ok(files) => found.extend(files.into_iter().filter(|file| known.insert(file.path.clone()))),
                    Err(why) => faults.add(said(why)),
                }
            }
            Ok::<Vec<WrittenFile>, EngineError>(found)
        };
        let (graph_files, models) = (files(&row.graphs)?, files(&row.models)?);
        let mut is_complete = true;
        let mut with_variants = Vec::new();
        let mut patterns = UnusedPatterns::of(row);
        for file in graph_files {
            stop_if_canceled(progress)?;
            match graphs.open(&file.path) {
                Err(error) => {
                    is_complete = false;
                    faults.add(error);
                }
                Ok(graph) => match variants(row, &values, &graph.open, &mut patterns) {
                    Ok(choices) => with_variants.push((file, choices)),
                    Err(why) => faults.add(said(why)),
                },
            }
        }
        // A graph that cannot be opened may have a variant that fits, so unused patterns are reported only if all graphs were opened.
        if is_complete {
            patterns.sentences().for_each(|why| faults.add(said(why)));
        }
        with_variants.retain(|(file, choices)| {
            // If such a pattern fits no variant, that fault has been reported already.
            if choices.is_empty() && patterns.0.is_empty() {
                let why = format!(
                    "{} has no variant that is asked for; add \"\" to 'variants' for its own values, or leave the graph out",
                    file.written
                );
                faults.add(said(why));
            }
            !choices.is_empty()
        });
        Ok(Expansion {
            row,
            models,
            graphs: with_variants,
            values,
        })
    }

    fn count(&self) -> u64 {
        let variants: usize = self.graphs.iter().map(|(_, variants)| variants.len()).sum();
        let row = self.row;
        let axes = [
            self.models.len(),
            variants,
            row.seeds.len().max(1),
            row.sizes.len(),
            row.presets.len(),
        ];
        axes.into_iter()
            .fold(1, |product: u64, axis| product.saturating_mul(axis as u64))
    }

    /// Returns the greatest number of values that an item sets.
    fn value_count(&self) -> usize {
        let choices = self.graphs.iter().flat_map(|(_, choices)| choices);
        let of_choice = choices.map(|choice| choice.set.len()).max().unwrap_or(0); // Without a graph there is no item.
        self.values.set.len() + of_choice
    }

    fn add_to(&self, drafts: &mut Vec<Draft<'m>>) {
        let row = self.row;
        let seeds = |model: &WrittenFile| match row.seeds.is_empty() {
            true => vec![self.values.seed],
            false => row.seeds.iter().map(|seed| Some(seed.of(model))).collect(),
        };
        for model in &self.models {
            for (graph, variants) in &self.graphs {
                for choice in variants {
                    for seed in seeds(model) {
                        for size in &row.sizes {
                            let draft = |presets: &'m Vec<String>| Draft {
                                row,
                                graph: graph.clone(),
                                model: model.clone(),
                                variant: choice.variant.clone(),
                                variant_name: choice.name.clone().or_else(|| choice.variant.clone()),
                                seed,
                                set: self.values.set.iter().chain(&choice.set).cloned().collect(),
                                size: *size,
                                presets,
                            };
                            drafts.extend(row.presets.iter().map(draft));
                        }
                    }
                }
            }
        }
    }
}

impl RowValues {
    /// Returns the values of a table and of its files. Adds the faults of files.
    fn of(row: &MatrixRow, base: &PathBase, faults: &mut FaultList) -> RowValues {
        let mut values = RowValues {
            variant: None,
            seed: None,
            set: Vec::new(),
        };
        for written in &row.set_files {
            let file = match SetFile::open(&base.resolve(written)) {
                Ok(file) => file,
                Err(error) => {
                    faults.add(error);
                    continue;
                }
            };
            values.variant = file.variant.or(values.variant);
            values.seed = file.seed.or(values.seed);
            values.set.extend(file.set);
        }
        values.set.extend(row.set.iter().cloned());
        values
    }
}

/// Pattern for all variants of a graph. It also fits a graph that has none.
const ALL_VARIANTS: &str = "*";

/// Patterns of a table that have not fitted any variant of its graphs so far.
struct UnusedPatterns<'m>(Vec<&'m str>);

impl<'m> UnusedPatterns<'m> {
    fn of(row: &'m MatrixRow) -> UnusedPatterns<'m> {
        let named = row.variants.iter().filter_map(|choice| choice.variant.as_deref());
        UnusedPatterns(named.filter(|text| is_pattern(text) && *text != ALL_VARIANTS).collect())
    }

    /// Clauses about them.
    fn sentences(&self) -> impl Iterator<Item = String> {
        let sentence = |pattern: &&str| format!("none of its graphs has a variant that fits '{pattern}'");
        self.0.iter().map(sentence)
    }
}

fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?'])
}

/// Returns the variants of a graph that a table requests; may be empty. The error is a clause. Removes patterns that fit from `patterns`.
fn variants(
    row: &MatrixRow,
    values: &RowValues,
    open: &OpenGraph,
    patterns: &mut UnusedPatterns<'_>,
) -> Result<Vec<VariantChoice>, String> {
    if row.variants.is_empty() {
        return Ok(vec![VariantChoice {
            variant: values.variant.clone(),
            ..VariantChoice::default()
        }]);
    }
    let mut found = Vec::new();
    for choice in &row.variants {
        let Some(pattern) = choice.variant.as_ref().filter(|text| is_pattern(text)) else {
            found.push(choice.clone());
            continue;
        };
        let parsed = Pattern::new(pattern).map_err(|error| format!("'{pattern}' is no pattern: {}", error.msg))?;
        let known = open.document.graph.variants().keys();
        let fitting = known.filter(|name| parsed.matches(name)).map(|name| VariantChoice {
            // One name cannot be used for several variants.
            name: None,
            variant: Some(name.clone()),
            set: choice.set.clone(),
        });
        let before = found.len();
        found.extend(fitting);
        if found.len() > before {
            patterns.0.retain(|unused| *unused != pattern.as_str());
        }
    }
    Ok(found)
}

impl SeedChoice {
    /// Returns the seed for a model. A seed for each model is computed from its path, so that further models do not change it.
    fn of(self, model: &WrittenFile) -> u32 {
        match self {
            SeedChoice::Number(seed) => seed,
            SeedChoice::PerModel => {
                let hash = blake3::hash(model.written.as_bytes());
                let [a, b, c, d, ..] = *hash.as_bytes();
                u32::from_le_bytes([a, b, c, d])
            }
        }
    }
}

impl Exclusion {
    /// Returns true if all conditions apply, and records that.
    fn applies_to(&self, draft: &Draft<'_>) -> bool {
        let applies = self.conditions.iter().all(|(key, condition)| match (key, condition) {
            (ExclusionKey::Size, Condition::Number(size)) => draft.size == *size,
            (ExclusionKey::Seed, Condition::Number(seed)) => draft.seed == Some(*seed),
            (ExclusionKey::Graph, Condition::Text(pattern)) => is_file(pattern, &draft.graph),
            (ExclusionKey::Model, Condition::Text(pattern)) => is_file(pattern, &draft.model),
            (ExclusionKey::Preset, Condition::Text(pattern)) => {
                draft.presets.iter().any(|preset| pattern.matches(preset))
            }
            (ExclusionKey::Variant, Condition::Text(pattern)) => {
                // The graph's own values have an empty variant name.
                pattern.matches(draft.variant_name.as_deref().unwrap_or(""))
            }
            _ => false,
        });
        self.is_used.set(self.is_used.get() || applies);
        applies
    }
}

/// Returns true if a pattern fits a file's path, or its name without folder and extension.
fn is_file(pattern: &Pattern, file: &WrittenFile) -> bool {
    pattern.matches(&file.written) || pattern.matches(&file.stem())
}
