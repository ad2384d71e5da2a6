//! Report of a bake, for people and for scripts.

use std::collections::BTreeMap;

use sabi_export::preset::NormalY;
use sabi_export::{
    ConstantRecord, DocumentRecord, EngineMemory, LookChange, NamedPreset, OutputRecord, UnmappedChannels,
};
use sabi_files::{PathBase, absolute};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::baking::made_of::inputs::InputRecord;
use crate::baking::made_of::recipe::{Recipe, moved};
use crate::opening::mesh_report::{DecodedUvs, UnwrappingReport};
use crate::opening::overlap::OverlapReport;
use crate::phases::PhaseTimes;
use crate::program::Build;
use crate::warning::Warning;

/// Version of reports. Since version 2, they describe how the maps were made.
pub const REPORT_VERSION: u32 = 2;

/// Report of a bake; docs/report.md lists the keys of its file.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BakeReport {
    /// Version of the report.
    pub version: u32,
    /// Version of Sabi.
    pub sabi: &'static str,
    /// The program.
    pub build: Build,
    /// The bake: graph, model and settings. Paths are absolute.
    pub recipe: Recipe,
    /// Files that the bake read. Paths are absolute.
    pub inputs: Vec<InputRecord>,
    /// Meaning of the maps' values.
    pub conventions: Conventions,
    /// Path of the graph as it was given.
    pub graph: String,
    /// The model.
    pub mesh: BakedMesh,
    /// Adapter that ran the graph.
    pub adapter: BakeAdapter,
    /// Texels along a side of the maps.
    pub size: u32,
    /// Nodes that results depend on, after groups are inlined.
    pub nodes: usize,
    /// Kernels of the graph.
    pub passes: usize,
    /// Kernels that only exports need.
    pub finish_passes: usize,
    /// Ids of nodes that share a kernel, a list for each kernel of more than one.
    pub fused: Vec<Vec<String>>,
    /// Number of texels over which the kernels of the graph ran, in whole tiles, summed over all kernels.
    pub evaluated_texels: u64,
    /// Maximum number of bytes that textures took at the same time.
    pub peak_texture_bytes: u64,
    /// True if nothing had to be done, because all files of an earlier bake were there. The times are those of the earlier bake.
    pub up_to_date: bool,
    /// True if the atlas was read from the cache.
    pub atlas_cached: bool,
    /// Ids of nodes whose rays were read from the cache.
    pub rays_cached: Vec<String>,
    /// Ids of nodes whose results were read from the cache.
    pub results_cached: Vec<String>,
    /// Maps that were not encoded, because their pixels are the same as in an earlier bake.
    pub maps_cached: Vec<String>,
    /// True if the unwrapping was read from the cache; `None` if the model's own UVs are used.
    pub unwrapping_cached: Option<bool>,
    /// Times of the phases.
    #[serde(rename = "stages_ms")]
    pub times: PhaseTimes,
    /// Milliseconds by node.
    pub nodes_ms: BTreeMap<String, f64>,
    /// Maps that were written.
    pub outputs: Vec<OutputRecord>,
    /// Memory of the maps in an engine.
    pub engine: EngineMemory,
    /// Channels without a map because they are the same everywhere.
    pub constants: Vec<ConstantRecord>,
    /// Documents of materials that name the maps.
    pub documents: Vec<DocumentRecord>,
    /// Channels of materials for which presets have no map.
    pub left_out: Vec<UnmappedChannels>,
    /// Warnings for the artist, as sentences with their remedies.
    #[schemars(with = "Vec<String>")]
    pub warnings: Vec<Warning>,
    /// Copy of the model that uses the maps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<ModelCopyReport>,
    /// Names of all files that were written.
    #[serde(skip)]
    pub files: Vec<String>,
}

impl BakeReport {
    /// Returns the report for a file of this base. Paths are relative to its folder if they share more than the root with it.
    #[must_use]
    pub fn placed(&self, base: &PathBase) -> BakeReport {
        // All paths are absolute, so the current folder does not matter.
        let from = PathBase::of_folder(absolute(base.folder()));
        let mut report = self.clone();
        report.recipe = report.recipe.moved(&from, base);
        for input in &mut report.inputs {
            input.path = moved(&input.path, &from, base);
        }
        report
    }

    /// Returns all files of the bake: their paths relative to the output folder, and the BLAKE3 of their bytes.
    pub fn written_files(&self) -> impl Iterator<Item = (&str, &str)> {
        let maps = self.outputs.iter().map(|output| (&*output.path, &*output.blake3));
        let documents = self.documents.iter();
        let documents = documents.map(|document| (&*document.path, &*document.blake3));
        let model = self.model.iter();
        let copied = model.flat_map(|model| std::iter::once(&model.copy).chain(&model.files));
        maps.chain(documents)
            .chain(copied.map(|file| (&*file.path, &*file.blake3)))
    }
}

/// Meaning of the values of maps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Conventions {
    /// Tangents of normal maps.
    pub tangents: &'static str,
    /// Direction of green in normal maps by preset: `+` up, as OpenGL has it, or `-` down, as DirectX does.
    pub normal_y: BTreeMap<String, &'static str>,
    /// Primaries of colors.
    pub primaries: &'static str,
    /// Unit of heights.
    pub height: &'static str,
}

impl Conventions {
    /// Returns the conventions of maps of these presets.
    pub(crate) fn of(presets: &[NamedPreset]) -> Conventions {
        let green = |named: &NamedPreset| match named.preset.normal_y {
            NormalY::Up => "+",
            NormalY::Down => "-",
        };
        Conventions {
            tangents: "mikktspace",
            normal_y: presets
                .iter()
                .map(|named| (named.preset.name.clone(), green(named)))
                .collect(),
            primaries: "bt709",
            height: "model units",
        }
    }
}

/// The model of a bake.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BakedMesh {
    /// Path of the model as it was given.
    pub file: String,
    /// Triangles of all parts.
    pub triangles: usize,
    /// Charts in UV. A chart that overlaps itself counts as the parts that do not.
    pub charts: usize,
    /// Share of the atlas that charts cover.
    pub coverage: f64,
    /// Lowest and highest coordinates of the model, in the units of its file.
    pub bounds: [[f32; 3]; 2],
    /// Charts that share places on the maps.
    pub overlap: OverlapReport,
    /// Results of unwrapping the model; `None` if its own UVs are used.
    pub unwrapped: Option<UnwrappingReport>,
    /// UVs that the file stores under a transform.
    pub decoded_uvs: Vec<DecodedUvs>,
    /// Angle between faces up to which the shading was smoothed, degrees; `None` for the normals of the file.
    pub smooth_degrees: Option<f32>,
    /// Names of the parts of the file that were left out.
    pub parts_left_out: Vec<String>,
    /// Number of faces that were turned because they were inside out.
    pub turned_faces: usize,
}

/// The adapter of a bake.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct BakeAdapter {
    /// Name as the driver gives it.
    pub name: String,
    /// `cpu`, `integrated` or `discrete`.
    pub kind: String,
}

/// The copy of the model that uses the maps, with the files it needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ModelCopyReport {
    /// The model's file.
    #[serde(flatten)]
    pub copy: CopiedFileReport,
    /// Files beside it.
    pub files: Vec<CopiedFileReport>,
    /// Changes of the looks of the materials that received maps.
    pub changes: Vec<LookChange>,
}

/// A file of a model's copy.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct CopiedFileReport {
    /// The file, relative to the output folder.
    pub path: String,
    /// BLAKE3 of the file's bytes, hexadecimal.
    pub blake3: String,
}
