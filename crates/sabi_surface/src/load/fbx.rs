//! FBX, as text and binary, read by the crate `ufbx`.
//!
//! The unit and the axes that the file declares are used to convert the model to meters, right-handed, with +Y up, before
//! [`LoadOptions`] rotate and scale it. UV sets are numbered by their order in a mesh. Vertex colors are interpreted as
//! sRGB, like in the programs that write them; material colors as linear. Missing normals are computed from the file's
//! smoothing, or are smooth up to an angle of 80° if it has none. Hidden nodes, coarser levels of detail, skins, morph
//! targets and animations are ignored: the scene is read in its stored pose.

mod material;
mod mesh;
mod nodes;
mod textures;

use std::borrow::Cow;
use std::collections::BTreeMap;

use sabi_cancel::{Cancel, look};
use ufbx::{
    AllocatorOpts, ErrorType, FileFormat, LoadOpts, MirrorAxis, OpenFileCb, ProgressCb, ProgressResult, WarningType,
};

use self::material::FbxMaterials;
use super::LoadOptions;
use super::assembly::{self, Assembly};
use super::error::{ModelFault, damaged};
use super::gltf::Resolve;
use super::parts::NodeGroups;
use super::polygon::Budget;
use super::skin_rest::{JointBudget, RestPose};
use super::text::with_line_feeds;
use super::warnings::Warnings;
use crate::model::{Model, ModelMaterial};

/// First bytes of binary files, and of text files as written by all programs.
pub(super) const MARKS: [&[u8]; 2] = [b"Kaydara FBX Binary", b"; FBX"];

/// Memory in bytes that any file may use, however small.
const LEAST_MEMORY: usize = 64 << 20;
/// Memory in bytes for each byte of a file: numbers may be compressed, and are converted to 64-bit floats.
const MEMORY_OF_A_BYTE: usize = 256;

/// Reads an `.fbx` file.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve,
    options: &LoadOptions,
) -> Result<Model, ModelFault> {
    let mut warnings = Warnings::default();
    // The library ends comments of a text file only at line feeds.
    let text = if bytes.starts_with(b";") {
        with_line_feeds(bytes)
    } else {
        Cow::Borrowed(bytes)
    };
    if writes_commas(&text) {
        return Err(ModelFault::Format(COMMAS.into()));
    }
    let scene = opened(&text, options.memory_bytes)?;
    note_omissions(&scene, &mut warnings);
    let mut groups = NodeGroups::default();
    let shown = nodes::shown(&scene, &mut groups, &mut warnings);
    let mut looks = FbxMaterials::new(&scene, &shown, super::stem(name));
    let materials: Vec<ModelMaterial> = scene
        .materials
        .iter()
        .map(|material| looks.material(material, &mut warnings))
        .collect();
    let mut assembly = Assembly {
        materials,
        groups,
        pictures: looks.pictures,
        ..Assembly::default()
    };
    let mut places = BTreeMap::new();
    let mut sources: Vec<FbxSourceMesh> = Vec::new();
    let mut joints = JointBudget::default();
    for node in &shown {
        let place = *places.entry(node.mesh.element.typed_id).or_insert_with(|| {
            sources.push(FbxSourceMesh {
                mesh: node.mesh,
                rest: nodes::rest(node.mesh, &mut joints),
                who: format!("mesh `{}`", node.name()),
            });
            sources.len() - 1
        });
        let instance = node.instance(place, &sources[place], &mut warnings);
        assembly.instances.push(instance);
    }
    let triangles = shown.iter().map(|node| node.mesh.num_triangles as u64);
    assembly::check_triangles(triangles, options.memory_bytes)?;
    let sets = assembly.texture_sets(sources.len());
    let mut budget = Budget::default();
    for (source, sets) in sources.iter().zip(&sets) {
        look();
        assembly.uv_sets.extend(0..source.mesh.uv_sets.len() as u32);
        let reader = mesh::FbxMeshReader { options, sets };
        let submesh = reader.read(source, &mut budget, &mut warnings);
        assembly.meshes.push(vec![submesh]);
    }
    assembly.into_model(name, resolve, options, warnings)
}

/// Sentence about numbers such as `0,5`. FBX separates the numbers of a list with commas, so that such a list cannot be read.
const COMMAS: &str = "it writes numbers with decimal commas, such as `0,5`, which cannot be told apart from the commas between \
                      numbers; export it with decimal points (set the program or the system to English), or as binary FBX";

/// Lists of fractions in a text.
const FRACTIONS: [&str; 4] = ["Vertices", "Normals", "UV", "Colors"];

/// Returns true if a list of fractions in a text has more of them than it says, and none with a decimal point.
fn writes_commas(text: &[u8]) -> bool {
    // Binary files have their lists elsewhere.
    if !text.starts_with(b";") {
        return false;
    }
    let text = String::from_utf8_lossy(text);
    let mut promised = None;
    for line in text.lines() {
        let (key, rest) = line.split_once(':').unwrap_or(("", line)); // A list may go on over several lines.
        if let Some(count) = rest.trim().strip_prefix('*') {
            let digits = count.trim_end_matches(|letter: char| !letter.is_ascii_digit());
            let count = digits.parse::<usize>().ok();
            promised = count.filter(|_| FRACTIONS.contains(&key.trim()));
        } else if key.trim() == "a"
            && let Some(promised) = promised.take()
            && !rest.contains('.')
            && rest.split(',').filter(|number| !number.trim().is_empty()).count() > promised
        {
            return true;
        }
    }
    false
}

/// A mesh that any node shows.
struct FbxSourceMesh<'s> {
    mesh: &'s ufbx::Mesh,
    rest: RestPose,
    /// Name in warnings.
    who: String,
}

/// Opens the scene, in meters and right-handed with +Y up. No other file is opened, and memory is limited, each of what is kept and of what is not.
fn opened(bytes: &[u8], memory_bytes: u64) -> Result<ufbx::SceneRoot, ModelFault> {
    let limit = bytes
        .len()
        .saturating_mul(MEMORY_OF_A_BYTE)
        .saturating_add(LEAST_MEMORY);
    let allowed = usize::try_from(memory_bytes).unwrap_or(usize::MAX);
    let is_of_file = limit <= allowed;
    let limit = limit.min(allowed);
    let limited = || AllocatorOpts {
        memory_limit: limit,
        ..AllocatorOpts::default()
    };
    let no_file = |_: &str, _: &ufbx::OpenFileInfo| None;
    let cancel = Cancel::current();
    // Nothing unwinds through the library, which is written in C.
    let go_on = |_: &ufbx::Progress| match cancel.is_made() {
        true => ProgressResult::Cancel,
        false => ProgressResult::Continue,
    };
    let options = LoadOpts {
        temp_allocator: limited(),
        result_allocator: limited(),
        ignore_animation: true,
        skip_skin_vertices: true,
        skip_mesh_parts: true,
        use_blender_pbr_material: true,
        force_single_thread_ascii_parsing: true,
        generate_missing_normals: true,
        open_file_cb: OpenFileCb::Ref(&no_file),
        progress_cb: ProgressCb::Ref(&go_on),
        target_axes: ufbx::CoordinateAxes::right_handed_y_up(),
        target_unit_meters: 1.0,
        // Keep the directions of up and front.
        handedness_conversion_axis: MirrorAxis::X,
        file_format: FileFormat::Fbx,
        no_format_from_content: true,
        no_format_from_extension: true,
        ..LoadOpts::default()
    };
    let loaded = ufbx::load_memory(bytes, options);
    cancel.look();
    loaded.or_else(|error| match error.type_ {
        // How much more it takes is not known before it is read.
        ErrorType::MemoryLimit if !is_of_file => Err(ModelFault::memory(memory_bytes.saturating_add(1), memory_bytes)),
        ErrorType::MemoryLimit | ErrorType::AllocationLimit | ErrorType::OutOfMemory => {
            damaged("it promises more data than a file of its size has")
        }
        ErrorType::TruncatedFile | ErrorType::Io | ErrorType::EmptyFile => damaged("it was cut off"),
        ErrorType::UnrecognizedFileFormat => damaged("it is no FBX file"),
        ErrorType::UnsupportedVersion => Err(ModelFault::Format(
            "its version of FBX is not read here: export it as FBX 2011 or later, or as glTF 2.0 (.glb)".into(),
        )),
        _ => damaged("it contradicts the rules of FBX, or was cut off"),
    })
}

/// Warns about features of the scene that are not supported in a model.
fn note_omissions(scene: &ufbx::Scene, warnings: &mut Warnings) {
    if scene.metadata.mirror_axis != MirrorAxis::None {
        warnings.add(
            "The axes of the file are left-handed: the model was mirrored at x = 0, up and front stay where they are.",
        );
    }
    let curves = scene.nurbs_curves.len() + scene.line_curves.len();
    let surfaces = scene.nurbs_surfaces.len() + scene.nurbs_trim_surfaces.len() + scene.procedural_geometries.len();
    if curves > 0 {
        warnings.add("Points and lines are left out.");
    }
    if surfaces > 0 {
        warnings.add(
            "Curved surfaces (NURBS) and procedural ones are left out; convert them to polygons before the export.",
        );
    }
    if !scene.anim_layers.is_empty() && !scene.anim_values.is_empty() {
        warnings.add("Animations are left out: the scene is taken as it stands without them.");
    }
    for warning in &*scene.metadata.warnings {
        match warning.type_ {
            WarningType::IndexClamped => {
                warnings
                    .add("Faces name vertices or attributes that the file does not have; others were taken instead.");
            }
            WarningType::TruncatedArray | WarningType::MissingGeometryData => {
                warnings.add("Some lists of the file are shorter than they should be; check the model.");
            }
            _ => {}
        }
    }
}
