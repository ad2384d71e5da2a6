//! Planning: a matrix becomes a plan, and what could not be baked is refused.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use sabi_files::{PathBase, canonical};
use serde_json::{Map, Value as Json, json};

use super::expansion::{Draft, GraphWithKinds, Graphs, expanded};
use super::faults::Faults;
use super::inputs::{InputHashes, InputRecord, NamedInputs, inputs_of_graph, inputs_of_model};
use super::item::{BUILD, BakeItem, ItemMachine};
use super::matrix::Matrix;
use super::matrix_row::Exclusion;
use super::out_folders::{first_clash, out_folder};
use super::plan_file::BakePlan;
use crate::baking::bake::check_bake;
use crate::baking::presets::preset_file;
use crate::error::{EngineError, ErrorKind};
use crate::packing::named_files::whole_path;
use crate::phases::{Phase, Progress, stop_if_canceled};

/// A plan with warnings about its matrix.
#[derive(Debug)]
pub struct PlannedBakes {
    /// The plan.
    pub plan: BakePlan,
    /// Warnings, as sentences.
    pub warnings: Vec<String>,
}

/// Expands a matrix into a plan for a file in `folder`. Every graph is checked as a bake checks it, every model is read for its
/// files, and every input is hashed; no adapter is needed. `preset_folder` has presets of the user's own.
///
/// # Errors
/// Sentences about all that is missing or wrong, or about two items that would write into one folder.
pub fn plan_bakes(
    matrix: &Path,
    folder: &Path,
    preset_folder: Option<&Path>,
    progress: &dyn Progress,
) -> Result<PlannedBakes, EngineError> {
    let matrix = Matrix::open(matrix)?;
    let mut graphs = Graphs::default();
    let drafts = expanded(&matrix, &mut graphs)?;
    if drafts.is_empty() {
        let why = format!("{}: 'exclude' leaves nothing to bake", matrix.path.display());
        return Err(EngineError::new(ErrorKind::BadInput, why));
    }
    let absolute = canonical(folder).map_err(|_| {
        let why = format!("there is no folder {}; make it, or name another file", folder.display());
        EngineError::new(ErrorKind::CannotWrite, why)
    })?;
    let mut planner = ItemPlanner {
        matrix: &matrix,
        base: PathBase::of_folder(absolute),
        shown: PathBase::of_folder(folder),
        preset_folder,
        graphs,
        of_graphs: BTreeMap::new(),
        of_models: BTreeMap::new(),
        hashes: InputHashes::default(),
        checked: BTreeSet::new(),
    };
    refuse_clashes(&matrix, &drafts)?;
    let (mut items, mut faults) = (Vec::new(), Faults::default());
    for (at, draft) in drafts.iter().enumerate() {
        stop_if_canceled(progress)?;
        match planner.item(at, draft) {
            Ok(item) => items.push(item),
            Err(error) => faults.add(error),
        }
        progress.advance(Phase::Load, at + 1, drafts.len());
    }
    faults.into_result()?;
    Ok(PlannedBakes {
        plan: BakePlan { items },
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
    /// Absolute folder of the plan's file.
    base: PathBase,
    /// The same folder as it was given, for messages.
    shown: PathBase,
    preset_folder: Option<&'m Path>,
    graphs: Graphs,
    of_graphs: BTreeMap<PathBuf, Rc<NamedInputs>>,
    of_models: BTreeMap<PathBuf, Result<Rc<NamedInputs>, EngineError>>,
    hashes: InputHashes,
    /// Settings that were checked.
    checked: BTreeSet<String>,
}

impl ItemPlanner<'_> {
    fn item(&mut self, at: usize, draft: &Draft<'_>) -> Result<BakeItem, EngineError> {
        let graph = self.graphs.open(&draft.graph.path)?;
        let (presets, preset_files) = self.presets(draft)?;
        let out = out_folder(draft).map_err(|why| EngineError::new(ErrorKind::BadInput, why))?;
        let mut item = BakeItem {
            item: at,
            key: String::new(),
            sabi: BUILD.to_owned(),
            graph: self.written(&draft.graph.written)?,
            mesh: self.written(&draft.model.written)?,
            out: self.written(&out)?,
            variant: draft.variant.clone(),
            seed: draft.seed,
            set: values(draft),
            size: draft.size,
            presets,
            options: draft.row.options.clone(),
            inputs: Vec::new(),
        };
        self.check(draft, &graph, &item)?;
        item.inputs = self.inputs(draft, &graph, &preset_files)?;
        item.key = item.hashed();
        Ok(item)
    }

    /// A path of the matrix for the plan.
    fn written(&self, written: &str) -> Result<String, EngineError> {
        self.path_text(&whole_path(&self.matrix.base(), written))
    }

    fn path_text(&self, path: &Path) -> Result<String, EngineError> {
        let text = self
            .base
            .write(path)
            .map_err(|error| EngineError::of(ErrorKind::BadInput, error))?;
        Ok(text.replace('\\', "/"))
    }

    /// Presets for the plan: names of those that come with Sabi, and paths of all others with their files.
    fn presets(&self, draft: &Draft<'_>) -> Result<(Vec<String>, Vec<PathBuf>), EngineError> {
        let (mut names, mut files) = (Vec::new(), Vec::new());
        for name in draft.presets {
            let path = self.matrix.base().resolve(name);
            let named = if super::item::is_file(name) {
                path.to_string_lossy().into_owned()
            } else {
                name.clone()
            };
            match preset_file(&named, self.preset_folder)? {
                None => names.push(named),
                Some(file) => {
                    let whole = whole_path(&PathBase::of_folder(""), &file.to_string_lossy());
                    names.push(self.path_text(&whole)?);
                    files.push(whole);
                }
            }
        }
        Ok((names, files))
    }

    /// Checks an item as its bake does before it reads the model, once for each graph and settings.
    fn check(&mut self, draft: &Draft<'_>, graph: &GraphWithKinds, item: &BakeItem) -> Result<(), EngineError> {
        let settings = json!([item.graph, item.variant, item.set, item.options, item.presets]).to_string();
        if !self.checked.insert(settings) {
            return Ok(());
        }
        let machine = ItemMachine::default();
        let mut request = item.request(&self.shown, &machine)?;
        request.graph.clone_from(&draft.graph.path);
        check_bake(&graph.open, &graph.kinds, &request)
    }

    fn inputs(
        &mut self,
        draft: &Draft<'_>,
        graph: &GraphWithKinds,
        presets: &[PathBuf],
    ) -> Result<Vec<InputRecord>, EngineError> {
        let of_graph = self.of_graphs.entry(draft.graph.path.clone());
        let of_graph = of_graph
            .or_insert_with(|| Rc::new(inputs_of_graph(&graph.open, &graph.kinds)))
            .clone();
        let of_model = self.of_models.entry(draft.model.path.clone());
        let of_model = of_model
            .or_insert_with(|| inputs_of_model(&draft.model.path).map(Rc::new))
            .clone()?;
        let mut all: NamedInputs = of_graph
            .iter()
            .chain(of_model.iter())
            .map(|(name, path)| (name.clone(), path.clone()))
            .collect();
        for file in presets {
            let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
            all.insert(format!("presets/{name}"), file.clone());
        }
        let record = |(name, path): (String, PathBuf)| {
            Ok(InputRecord {
                blake3: self.hashes.of(&path)?,
                path: self.path_text(&path)?,
                name,
            })
        };
        all.into_iter().map(record).collect()
    }
}

/// Values of a draft; of one name, the last.
fn values(draft: &Draft<'_>) -> Map<String, Json> {
    let mut set = Map::new();
    for (name, value) in &draft.set {
        // Values are plain data; what is none is refused with the graph.
        let json = serde_json::to_value(value).unwrap_or(Json::Null);
        // Its place is that of the last one, since names may mean the same parameter.
        set.shift_remove(name);
        set.insert(name.clone(), json);
    }
    set
}
