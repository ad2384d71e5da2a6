//! Items of a bake plan: one bake each, with all that a worker needs for it.

use std::path::{Path, PathBuf};

use sabi_files::PathBase;
use sabi_gpu::{AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::Value;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json, json};

use super::inputs::InputRecord;
use super::options::{ItemOptions, apply_options, plain_request};
use crate::baking::bake_request::BakeRequest;
use crate::error::{EngineError, ErrorKind};

/// Build of Sabi, which is part of every key: another one may give other bytes.
pub(super) const BUILD: &str = env!("CARGO_PKG_VERSION");

/// A bake of a plan. Paths start from the folder of the plan's file, with `/` between folders; docs/report.md lists the keys of its
/// line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BakeItem {
    /// Number in the plan, from 0 on.
    pub item: usize,
    /// Hash of everything that can change the maps: settings, contents of all inputs, and the build of Sabi.
    pub key: String,
    /// Build of Sabi that made the plan.
    pub sabi: String,
    /// Graph file.
    pub graph: String,
    /// Model file.
    pub mesh: String,
    /// Folder of the maps.
    pub out: String,
    /// Variant of the graph; none for its own values.
    pub variant: Option<String>,
    /// Seed in place of the graph's.
    pub seed: Option<u32>,
    /// Values by knob or `node.param`; later ones win.
    pub set: Map<String, Json>,
    /// Texels along a side of the maps.
    pub size: u32,
    /// Presets, by name or path.
    pub presets: Vec<String>,
    /// Other options.
    pub options: ItemOptions,
    /// Files that the bake reads.
    pub inputs: Vec<InputRecord>,
}

/// Options of the machine that runs an item; they change no result but by the adapter's own rounding.
#[derive(Clone, Debug)]
pub struct ItemMachine {
    /// Adapter to run on.
    pub adapter: AdapterChoice,
    /// Ray caster.
    pub caster: CasterChoice,
    /// Size limit of the textures of a run, bytes.
    pub budget_bytes: u64,
    /// Folder of the disk cache; none for no cache.
    pub cache_dir: Option<PathBuf>,
    /// True to write into folders that have files but no earlier maps.
    pub force: bool,
}

impl Default for ItemMachine {
    fn default() -> ItemMachine {
        ItemMachine {
            adapter: AdapterChoice::Auto,
            caster: CasterChoice::Auto,
            budget_bytes: DEFAULT_BUDGET_BYTES,
            cache_dir: None,
            force: false,
        }
    }
}

impl BakeItem {
    /// Hash of everything that can change the maps. Where the files are is no part of it, but what they are called is.
    pub(super) fn hashed(&self) -> String {
        let name = |path: &str| path.rsplit('/').next().unwrap_or(path).to_owned();
        let mut inputs: Vec<[&str; 2]> = self.inputs.iter().map(InputRecord::identity).collect();
        inputs.sort_unstable();
        let content = json!({
            "sabi": self.sabi,
            "graph": name(&self.graph),
            "mesh": name(&self.mesh),
            "variant": self.variant,
            "seed": self.seed,
            "set": self.set,
            "size": self.size,
            "presets": self.presets.iter().map(|preset| name(preset)).collect::<Vec<_>>(),
            "options": self.options.iter().collect::<std::collections::BTreeMap<_, _>>(),
            "inputs": inputs,
        });
        blake3::hash(content.to_string().as_bytes()).to_hex().to_string()
    }

    /// Returns the folder of the maps; `base` is that of the plan's file.
    pub fn folder(&self, base: &PathBase) -> PathBuf {
        base.resolve(&self.out)
    }

    /// Returns the request for this bake; `base` is that of the plan's file.
    ///
    /// # Errors
    /// The line has values that no plan has.
    pub fn request(&self, base: &PathBase, machine: &ItemMachine) -> Result<BakeRequest, EngineError> {
        let mut request = plain_request(&base.resolve(&self.graph), &base.resolve(&self.mesh), self.size);
        request.output = self.folder(base);
        // Those that come with Sabi have names, and all others are files.
        let preset = |name: &String| match is_file(name) {
            true => base.resolve(name).to_string_lossy().into_owned(),
            false => name.clone(),
        };
        request.presets = self.presets.iter().map(preset).collect();
        request.force = machine.force;
        let evaluator = &mut request.evaluator;
        evaluator.adapter = machine.adapter.clone();
        evaluator.caster = machine.caster;
        evaluator.budget_bytes = machine.budget_bytes;
        evaluator.model.cache_dir.clone_from(&machine.cache_dir);
        evaluator.overrides.variant.clone_from(&self.variant);
        evaluator.overrides.seed = self.seed;
        for (name, value) in &self.set {
            let value = Value::from_json(&value.to_string()).ok_or_else(|| {
                let why = format!("item {}: '{name}' has a number that no graph can hold", self.item);
                EngineError::new(ErrorKind::BadInput, why)
            })?;
            evaluator.overrides.set.push((name.clone(), value));
        }
        let applied = apply_options(&mut request, &self.options);
        applied.map_err(|why| EngineError::new(ErrorKind::BadInput, format!("item {}: {why}", self.item)))?;
        request.evaluator.overrides.fit = request.evaluator.fit;
        Ok(request)
    }
}

/// Returns true if a preset is named by the path of its file.
pub(super) fn is_file(preset: &str) -> bool {
    let ending = Path::new(preset).extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}
