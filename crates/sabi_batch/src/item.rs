//! Items of a bake plan: one bake each, with everything that a worker needs for it.

use std::path::PathBuf;

use sabi_engine::baking::BakeRequest;
use sabi_engine::baking::made_of::{Recipe, is_preset_file};
use sabi_engine::baking::recorded::is_finished_on_any_machine;
use sabi_engine::faults::FaultList;
use sabi_engine::opening::default_memory_bytes;
use sabi_engine::program::Build;
use sabi_engine::{EngineError, ErrorKind};
use sabi_files::{PathBase, TrustedPaths, path_from_stored, without_detours};
use sabi_gpu::{AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::inputs::{InputHashes, ItemInput};

/// A bake of a plan. Paths start from the folder of the plan's file, with `/` between folders; docs/report.md lists the keys of its
/// line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BakeItem {
    /// Number in the plan, from 0 on.
    pub item: usize,
    /// Hash of everything that can change the maps: settings, contents of all inputs, and the program.
    pub key: String,
    /// Folder of the maps.
    pub out: String,
    /// What is baked.
    pub recipe: Recipe,
    /// Files that the bake reads.
    pub inputs: Vec<ItemInput>,
    /// Program that made the plan.
    pub build: Build,
}

/// Options of the machine that runs an item. The maps depend on them only by rounding.
#[derive(Clone, Debug)]
pub struct ItemMachine {
    /// Adapter to run on.
    pub adapter: AdapterChoice,
    /// Ray caster.
    pub caster: CasterChoice,
    /// Size limit of the textures of a run, bytes.
    pub budget_bytes: u64,
    /// Folder of the disk cache; `None` for no cache.
    pub cache_dir: Option<PathBuf>,
    /// True to write into folders that have files but no earlier maps.
    pub force: bool,
    /// Paths from which the graphs and models may open the files that they name, in addition to their own folders and projects.
    pub trusted: TrustedPaths,
    /// Maximum memory for the files and pictures of a model, in bytes.
    pub memory_bytes: u64,
}

impl Default for ItemMachine {
    fn default() -> ItemMachine {
        ItemMachine {
            adapter: AdapterChoice::Auto,
            caster: CasterChoice::Auto,
            budget_bytes: DEFAULT_BUDGET_BYTES,
            cache_dir: None,
            force: false,
            trusted: TrustedPaths::default(),
            memory_bytes: default_memory_bytes(),
        }
    }
}

impl BakeItem {
    /// Returns a hash of everything that can change the maps. It contains the names of files but not their locations.
    pub(crate) fn hashed(&self) -> Result<String, EngineError> {
        let mut inputs: Vec<[&str; 2]> = self.inputs.iter().map(ItemInput::identity).collect();
        inputs.sort_unstable();
        let content =
            json!({ "recipe": without_folders(self.recipe.on_any_machine()), "inputs": inputs, "build": self.build });
        Ok(blake3::hash(content.to_string().as_bytes()).to_hex().to_string())
    }

    /// Returns the folder of the maps; `base` is that of the plan's file.
    pub fn folder(&self, base: &PathBase) -> PathBuf {
        let folder = path_from_stored(&self.out).unwrap_or_else(|| PathBuf::from(&self.out)); // Any text names some folder.
        without_detours(&base.folder().join(folder))
    }

    /// Returns the request for this bake; `base` is the absolute folder of the plan's file.
    pub fn request(&self, base: &PathBase, machine: &ItemMachine) -> BakeRequest {
        let recipe = self.recipe.clone().with_absolute_paths(base);
        // All presets that are not built in are named by their files.
        let mut request = recipe.request(&self.folder(base), machine.cache_dir.clone(), None);
        request.force = machine.force;
        request.evaluator.adapter = machine.adapter.clone();
        request.evaluator.caster = machine.caster;
        request.evaluator.budget_bytes = machine.budget_bytes;
        request.evaluator.model.memory_bytes = machine.memory_bytes;
        let trusted = &mut request.evaluator.model.trusted;
        *trusted = std::mem::take(trusted).with(&machine.trusted);
        request
    }

    /// Returns true if this program baked the item, on any adapter, and none of its files has changed. `base` is the
    /// absolute folder of the plan's file.
    pub fn is_finished(&self, base: &PathBase, hashes: &mut InputHashes) -> bool {
        let request = self.request(base, &ItemMachine::default());
        is_finished_on_any_machine(&request, |path| hashes.of(path).ok())
    }

    /// Refuses an item that another program planned, or that has an input which has changed since the plan was made. `base`
    /// is the absolute folder of the plan's file.
    ///
    /// # Errors
    /// A sentence for each input.
    pub fn refuse_changed(&self, base: &PathBase, hashes: &mut InputHashes) -> Result<(), EngineError> {
        let (own, other) = (Build::current(), &self.build);
        if own != other {
            let why = match own.version == other.version && own.system == other.system {
                true => "the plan was made by another build of Sabi; plan again".to_owned(),
                false => format!(
                    "the plan was made by Sabi {} for {}, and this is {} for {}; plan again",
                    other.version, other.system, own.version, own.system
                ),
            };
            return Err(EngineError::new(ErrorKind::BadInput, why));
        }
        let mut faults = FaultList::default();
        for input in &self.inputs {
            let path = base.resolve(&input.path);
            match hashes.of(&path) {
                Err(error) => faults.add(error),
                Ok(hash) if hash != input.blake3 => {
                    let why = format!("{} was changed after the plan was made; plan again", path.display());
                    faults.add(EngineError::new(ErrorKind::BadInput, why));
                }
                Ok(_) => {}
            }
        }
        faults.into_result()
    }
}

/// Returns a recipe that has only the names of its files.
fn without_folders(mut recipe: Recipe) -> Recipe {
    let name = |path: &str| path.rsplit('/').next().unwrap_or(path).to_owned(); // A path has a last part.
    recipe.graph = name(&recipe.graph);
    recipe.model.file = name(&recipe.model.file);
    for preset in recipe.presets.iter_mut().filter(|preset| is_preset_file(preset)) {
        *preset = name(preset);
    }
    recipe
}
