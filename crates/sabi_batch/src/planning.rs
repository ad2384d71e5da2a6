//! Planning: a matrix becomes a plan, and bakes that would fail are refused.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use sabi_engine::baking::BakeRequest;
use sabi_engine::baking::check_bake;
use sabi_engine::baking::made_of::{Recipe, is_preset_file, moved};
use sabi_engine::baking::presets::preset_files;
use sabi_engine::faults::FaultList;
use sabi_engine::packing::{NamedInputs, inputs_of_graph, inputs_of_model};
use sabi_engine::phases::{Phase, Progress, stop_if_canceled};
use sabi_engine::program::Build;
use sabi_engine::{EngineError, ErrorKind};
use sabi_files::{PathBase, TrustedPaths, canonical, named_path, stored_path, whole_path};
use sabi_graph::Value;

use crate::expansion::{Draft, GraphWithKinds, Graphs, expanded};
use crate::inputs::{InputHashes, ItemInput};
use crate::item::BakeItem;
use crate::matrix::Matrix;
use crate::matrix_row::Exclusion;
use crate::options::apply_options;
use crate::out_folders::{first_clash, out_folder};
use crate::plan_file::BakePlan;

/// A plan with warnings about its matrix.
#[derive(Debug)]
pub struct PlannedBakes {
    /// The plan.
    pub plan: BakePlan,
    /// Warnings, as sentences.
    pub warnings: Vec<String>,
}

/// Expands a matrix into a plan for a file in `folder`. Every graph is checked as a bake checks it, every model is read for its
/// files, and every input is hashed; no adapter is needed. `preset_folder` has presets of the user's own, and
/// `trusted` are paths from which the graphs and models may open what they name, besides their own folders and projects and those of
/// the matrix.
///
/// # Errors
/// Sentences about all that is missing or wrong, or about two items that would write into one folder.
pub fn plan_bakes(
    matrix: &Path,
    folder: &Path,
    preset_folder: Option<&Path>,
    trusted: &TrustedPaths,
    progress: &dyn Progress,
) -> Result<PlannedBakes, EngineError> {
    let mut graphs = Graphs::new(trusted.clone().with_file(matrix));
    let matrix = Matrix::open(matrix)?;
    let mut faults = FaultList::default();
    let drafts = expanded(&matrix, &mut graphs, &mut faults, progress)?;
    if drafts.is_empty() && faults.is_empty() {
        let why = format!("{}: 'exclude' leaves nothing to bake", matrix.path.display());
        return Err(EngineError::new(ErrorKind::BadInput, why));
    }
    let to = canonical(folder).map_err(|_| {
        let why = format!("there is no folder {}; make it, or name another file", folder.display());
        EngineError::new(ErrorKind::CannotWrite, why)
    })?;
    let from = canonical(matrix.base().folder()).map_err(|_| {
        let why = format!("{}: the folder of the matrix is gone", matrix.path.display());
        EngineError::new(ErrorKind::MissingInput, why)
    })?;
    let mut planner = ItemPlanner {
        matrix: &matrix,
        from: PathBase::of_folder(from),
        to: PathBase::of_folder(to),
        preset_folder,
        graphs,
        of_graphs: BTreeMap::new(),
        of_models: BTreeMap::new(),
        hashes: InputHashes::default(),
        checked: BTreeSet::new(),
    };
    let mut items = Vec::new();
    if let Err(error) = refuse_clashes(&matrix, &drafts) {
        faults.add(error);
    }
    for (at, draft) in drafts.iter().enumerate() {
        stop_if_canceled(progress)?;
        match planner.item(at, draft, progress) {
            Ok(item) => items.push(item),
            Err(error) => faults.add(error),
        }
        progress.advance(Phase::Load, at + 1, drafts.len());
    }
    faults.into_result()?;
    Ok(PlannedBakes {
        plan: BakePlan {
            base: planner.to,
            items,
        },
        warnings: unused_exclusions(&matrix),
    })
}

/// Refuses two items that would write into one folder.
fn refuse_clashes(matrix: &Matrix, drafts: &[Draft<'_>]) -> Result<(), EngineError> {
    let base = matrix.base();
    let bad = |why: String| EngineError::new(ErrorKind::BadInput, format!("{}: {why}", matrix.path.display()));
    let mut folders = Vec::new();
    for draft in drafts {
        let written = out_folder(draft).map_err(|why| bad(format!("{}: {why}", draft.row.words)))?;
        folders.push(whole_path(&base, &written));
    }
    let Some((one, other)) = first_clash(&folders) else {
        return Ok(());
    };
    let described = |at: usize| described(&drafts[at]);
    let folder = out_folder(&drafts[other]).unwrap_or_default(); // It was found above.
    Err(bad(format!(
        "{} and {} would both write into {folder}; tell them apart in 'out', with $mesh, $graph, $variant, $seed, $size, $preset or \
         $name",
        described(one),
        described(other)
    )))
}

/// Words for a draft.
fn described(draft: &Draft<'_>) -> String {
    let mut words = format!("{} on {}", draft.graph.written, draft.model.written);
    let variant = draft.variant_name.as_ref().map(|name| format!(", {name}"));
    let seed = draft.seed.map(|seed| format!(", seed {seed}"));
    words.extend(variant.into_iter().chain(seed));
    format!("{words}, {} as {}", draft.size, draft.presets.join(" and "))
}

fn unused_exclusions(matrix: &Matrix) -> Vec<String> {
    let is_unused = |exclusions: &[Exclusion]| exclusions.iter().filter(|exclusion| !exclusion.is_used.get()).count();
    let of_rows = matrix
        .rows
        .iter()
        .map(|row| (row.words.as_str(), is_unused(&row.exclusions)));
    let all = std::iter::once(("all tables", is_unused(&matrix.exclusions))).chain(of_rows);
    let said = all.filter(|(_, count)| *count > 0).map(|(words, count)| {
        let entries = match count {
            1 => "1 entry".to_owned(),
            count => format!("{count} entries"),
        };
        let leaves = if count == 1 { "leaves" } else { "leave" };
        format!(
            "{}: {entries} of 'exclude' of {words} {leaves} nothing out",
            matrix.path.display()
        )
    });
    said.collect()
}

/// Writer of items, which reads every file once.
struct ItemPlanner<'m> {
    matrix: &'m Matrix,
    /// Absolute folder of the matrix.
    from: PathBase,
    /// Absolute folder of the plan's file.
    to: PathBase,
    preset_folder: Option<&'m Path>,
    graphs: Graphs,
    of_graphs: BTreeMap<PathBuf, Rc<NamedInputs>>,
    of_models: BTreeMap<PathBuf, Result<Rc<NamedInputs>, EngineError>>,
    hashes: InputHashes,
    /// Settings that were checked.
    checked: BTreeSet<String>,
}

impl ItemPlanner<'_> {
    fn item(&mut self, at: usize, draft: &Draft<'_>, progress: &dyn Progress) -> Result<BakeItem, EngineError> {
        let graph = self.graphs.open(&draft.graph.path)?;
        let bad = |why: String| EngineError::new(ErrorKind::BadInput, why);
        let mut request = BakeRequest::plain(&draft.graph.path, &draft.model.path, draft.size);
        let mut faults = FaultList::default();
        if let Err(why) = apply_options(&mut request, &draft.row.options) {
            faults.add(bad(format!(
                "{}: {}: {why}",
                self.matrix.path.display(),
                draft.row.words
            )));
        }
        let overrides = &mut request.evaluator.overrides;
        overrides.variant.clone_from(&draft.variant);
        overrides.seed = draft.seed;
        overrides.set = values(draft);
        let presets = self.presets(draft, &mut faults);
        request.preset_folder = self.preset_folder.map(Path::to_owned);
        request.presets = presets.iter().map(|(shown, _)| shown.clone()).collect();
        if let Err(error) = self.check(&graph, &request) {
            faults.add(error);
        }
        let whole = |(shown, file): &(String, Option<PathBuf>)| {
            file.as_ref()
                .map_or_else(|| shown.clone(), |file| file.to_string_lossy().into_owned())
        };
        request.presets = presets.iter().map(whole).collect();
        // Messages show paths as they are written, but a plan needs complete paths.
        request.graph = whole_path(&self.from, &draft.graph.written);
        request.evaluator.model.path = whole_path(&self.from, &draft.model.written);
        // As it was told for all drafts.
        let out = out_folder(draft)
            .map_err(|why| bad(format!("{}: {}: {why}", self.matrix.path.display(), draft.row.words)))?;
        let out = whole_path(&self.from, &out);
        // The check has reported missing presets.
        let files_of_presets = presets.iter().filter_map(|(_, file)| file.as_ref());
        let files_of_presets = files_of_presets.filter(|file| file.exists());
        let mut item = BakeItem {
            item: at,
            key: String::new(),
            out: self.path_text(&out),
            recipe: Recipe::of(&request, None).moved(&self.from, &self.to),
            inputs: self
                .inputs(draft, &graph, files_of_presets, progress)
                .unwrap_or_else(|error| {
                    faults.add(error);
                    Vec::new()
                }),
            build: Build::current().clone(),
        };
        faults.into_result()?;
        item.key = item.hashed()?;
        Ok(item)
    }

    /// Returns a path for the plan: relative to its folder if both share more than the root.
    fn path_text(&self, path: &Path) -> String {
        moved(&stored_path(path), &self.from, &self.to)
    }

    /// Returns the presets of a draft as they are shown: names of built-in presets, and files of all others. Adds the
    /// faults of missing presets.
    fn presets(&self, draft: &Draft<'_>, faults: &mut FaultList) -> Vec<(String, Option<PathBuf>)> {
        let found = draft.presets.iter().map(|name| {
            let shown = match is_preset_file(name) {
                true => self.matrix.base().resolve(name).to_string_lossy().into_owned(),
                false => name.clone(),
            };
            let files = preset_files(std::slice::from_ref(&shown), self.preset_folder)?;
            let file = files.first().map(|file| named_path(file));
            Ok((shown, file))
        });
        let told = found.filter_map(|found: Result<_, EngineError>| found.map_err(|error| faults.add(error)).ok());
        told.collect()
    }

    /// Checks a request in the same way as its bake before it reads the model, once for each graph and settings.
    fn check(&mut self, graph: &GraphWithKinds, request: &BakeRequest) -> Result<(), EngineError> {
        let mut settings = Recipe::of(request, None);
        // What no check depends on.
        settings.model.file.clear();
        settings.seed = None;
        let settings = serde_json::to_string(&settings).map_err(|error| EngineError::of(ErrorKind::Defect, error))?;
        if !self.checked.insert(settings) {
            return Ok(());
        }
        let mut open = graph.open.clone();
        open.trusted = open.trusted.with(&request.evaluator.trusted_with(&request.graph));
        check_bake(&open, &graph.kinds, request)
    }

    fn inputs<'p>(
        &mut self,
        draft: &Draft<'_>,
        graph: &GraphWithKinds,
        presets: impl Iterator<Item = &'p PathBuf>,
        progress: &dyn Progress,
    ) -> Result<Vec<ItemInput>, EngineError> {
        let of_graph = self.of_graphs.entry(draft.graph.path.clone());
        let of_graph = of_graph.or_insert_with(|| Rc::new(inputs_of_graph(&graph.open, &graph.kinds)));
        let of_graph = Rc::clone(of_graph);
        let of_model = self.of_models.entry(draft.model.path.clone());
        let of_model = of_model
            .or_insert_with(|| inputs_of_model(&draft.model.path, self.graphs.trusted(), progress).map(Rc::new));
        let of_model = of_model.clone()?;
        let mut all: NamedInputs = of_graph.as_ref().clone();
        all.extend(of_model.iter().map(|(name, path)| (name.clone(), path.clone())));
        for file in presets {
            let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
            all.insert(format!("presets/{name}"), file.clone());
        }
        let record = |(name, path): (String, PathBuf)| {
            Ok(ItemInput {
                blake3: self.hashes.of(&path)?,
                path: moved(&stored_path(&path), &self.from, &self.to),
                name,
            })
        };
        all.into_iter().map(record).collect()
    }
}

/// Returns the values of a draft. If a name occurs several times, the last value is used, in its place: different names
/// may mean the same parameter.
fn values(draft: &Draft<'_>) -> Vec<(String, Value)> {
    let mut known = BTreeSet::new();
    let mut set: Vec<(String, Value)> = draft
        .set
        .iter()
        .rev()
        .filter(|(name, _)| known.insert(name))
        .cloned()
        .collect();
    set.reverse();
    set
}
