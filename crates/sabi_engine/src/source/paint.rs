//! `source/paint`: strokes that an artist painted on the surface.

use std::path::Path;
use std::sync::Arc;

use sabi_gpu::{PlaneData, TileSet, tile_of};
use sabi_graph::{FlatNode, PortType, Value};
use sabi_nodes::kind::Param;
use sabi_nodes::link::Plane;
use sabi_paint::{Canvas, CanvasLayers, Version};
use sabi_plan::{NoSuchValue, SourceKind, SourcePort, SourceStep};
use sabi_surface::model::Model;

use super::Files;
use super::strokes::{PaintedNodePlace, StrokeSearch, Strokes, paint_folder, picture_folder};
use super::texels::SourceSurface;

/// Id of the kind.
pub(crate) const NAME: &str = "source/paint";

/// Returns the kind and the parameter to remove from a graph whose strokes should not be visible.
pub fn without_paint() -> (String, String) {
    (NAME.to_owned(), "strokes".to_owned())
}

/// Index of each input among those of the kind.
const BASE: usize = 0;
const FROM: usize = 1;

/// Declares the kind.
pub(crate) fn kind() -> SourceKind {
    let mask = |name: &str, doc: &str| SourcePort::new(name, PortType::Mask, doc);
    SourceKind {
        id: NAME.to_owned(),
        label: "Paint".to_owned(),
        summary: "Strokes of a brush on the surface.".to_owned(),
        aliases: [
            "brush",
            "stroke",
            "draw",
            "hand",
            "mask paint",
            "sculpt",
            "projection",
            "text",
            "font",
            "letters",
            "writing",
            "label",
            "decal",
            "stencil",
        ]
        .map(str::to_owned)
        .to_vec(),
        params: vec![
            Param::text(
                "strokes",
                "",
                "The strokes, by the name of their version, one for each model that was painted on. They are stored in the \
                 folder beside the graph that ends in .paint.",
            ),
            Param::number(
                "empty",
                0.0,
                "The mask where nothing was painted, and on a model that was not painted on, while no base is connected.",
            )
            .within(0.0, 1.0),
        ],
        inputs: vec![
            mask("base", "The mask that is painted over.").optional("the value of Empty"),
            SourcePort::new(
                "from",
                PortType::Color,
                "The result that strokes copy which clone from another node; its luminance is the mask that they leave.",
            )
            .optional("nothing, and such strokes leave nothing"),
        ],
        outputs: vec![
            mask("mask", "The value of the strokes, over the base."),
            SourcePort::new(
                "color",
                PortType::Color,
                "The color of the strokes; black where nothing was painted. Lay it over something by the mask.",
            ),
            mask("height", "The height that strokes add or carve, 0 elsewhere."),
            SourcePort::new(
                "direction",
                PortType::Vector,
                "Direction of the strokes along the surface; its length is how much of the place is painted.",
            ),
        ],
        content: [0; 32],
    }
}

/// Returns a hash of the strokes of a paint node on a model, for the keys of its results; `None` for other nodes.
pub(crate) fn content(files: &Files<'_>, node: &FlatNode, model: &Model) -> Option<[u8; 32]> {
    if node.kind != NAME || node.muted {
        return None;
    }
    let written = match node.params.get("strokes") {
        Some(Value::Text(written)) => written.as_str(),
        _ => "",
    };
    let found = files.strokes.find(&files.file_of(node), &model.stem, written);
    if let Some(version) = found.version() {
        files.strokes.keep_for_evaluation(version, &model.stem);
    }
    let version = found.version().unwrap_or(Version::EMPTY);
    let mut hash = blake3::Hasher::new();
    hash.update(&version.0);
    for picture in files.strokes.missing_pictures(&files.file_of(node), version) {
        hash.update(picture.as_str().as_bytes());
    }
    Some(*hash.finalize().as_bytes())
}

/// Result of a paint node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PaintOutput {
    Mask,
    Color,
    Height,
    Direction,
}

impl PaintOutput {
    /// Returns the result with this name, which is one that the kind declares.
    fn named(name: &str) -> PaintOutput {
        match name {
            "mask" => PaintOutput::Mask,
            "color" => PaintOutput::Color,
            "height" => PaintOutput::Height,
            _ => PaintOutput::Direction,
        }
    }

    /// Returns what of the strokes it shows.
    fn layers(self) -> CanvasLayers {
        CanvasLayers {
            value: self == PaintOutput::Mask,
            color: self == PaintOutput::Color,
            height: self == PaintOutput::Height,
            direction: self == PaintOutput::Direction,
        }
    }
}

/// Paint of a node, in the form of its results.
pub(crate) struct PaintedNode<'a> {
    surface: &'a SourceSurface<'a>,
    output: PaintOutput,
    empty: f32,
    base: Option<&'a PlaneData>,
    canvas: Option<Arc<Canvas>>,
}

impl<'a> PaintedNode<'a> {
    /// Returns the paint of a node for a result. `graph` is the file that contains the node. Adds a warning if strokes are missing.
    pub(crate) fn of(
        surface: &'a SourceSurface<'a>,
        strokes: &Strokes,
        graph: &Path,
        step: &SourceStep,
        output: &str,
        inputs: &'a [Option<PlaneData>],
        warnings: &mut Vec<String>,
    ) -> Result<PaintedNode<'a>, NoSuchValue> {
        let output = PaintOutput::named(output);
        let (written, empty) = (step.values.text("strokes")?, step.values.number("empty")?);
        let input = |port: usize| inputs.get(port).and_then(Option::as_ref);
        Ok(PaintedNode {
            canvas: canvas(
                surface,
                strokes,
                graph,
                &step.id,
                written,
                output.layers(),
                input(FROM),
                warnings,
            ),
            base: input(BASE),
            surface,
            output,
            empty,
        })
    }

    /// All texels of a plane of the result.
    pub(crate) fn plane(&self, plane: Plane) -> Vec<u8> {
        self.surface.indexed_texels(plane, |texel| self.texel(texel))
    }

    /// The texels of some tiles of a plane of the result.
    pub(crate) fn tiles(&self, plane: Plane, tiles: &TileSet) -> Vec<u8> {
        self.surface.indexed_tiles(plane, tiles, |texel| self.texel(texel))
    }

    fn texel(&self, texel: usize) -> [f32; 4] {
        let base = || self.base.map_or(self.empty, |base| base.texel(texel)[0]);
        let Some(canvas) = &self.canvas else {
            return match self.output {
                PaintOutput::Mask => [base(), 0.0, 0.0, 1.0],
                PaintOutput::Color | PaintOutput::Height | PaintOutput::Direction => [0.0, 0.0, 0.0, 1.0],
            };
        };
        let painted = canvas.texel(texel);
        let cover = painted.cover;
        match self.output {
            PaintOutput::Mask => [painted.value + (1.0 - cover) * base(), 0.0, 0.0, 1.0],
            PaintOutput::Height => [painted.height * self.surface.working_from_model as f32, 0.0, 0.0, 1.0],
            PaintOutput::Color => {
                let [red, green, blue] = painted.color.map(|value| if cover > 0.0 { value / cover } else { 0.0 });
                [red, green, blue, 1.0]
            }
            PaintOutput::Direction => {
                let [x, y, z] = painted.direction;
                [x, y, z, 1.0]
            }
        }
    }
}

/// Returns true if a node differs from its earlier state only in its strokes, none of which copies from another node.
pub(crate) fn is_plainly_painted_on(before: &SourceStep, now: &SourceStep) -> bool {
    let is_connected = now.reads.get(FROM).is_some_and(Option::is_some);
    is_painted_on(before, now) && !is_connected
}

/// Returns true if a node differs from its earlier state only in its strokes.
fn is_painted_on(before: &SourceStep, now: &SourceStep) -> bool {
    let empty = |step: &SourceStep| step.values.number("empty").ok();
    now.kind == NAME && before.kind == NAME && empty(before) == empty(now)
}

/// Returns the tiles in which the paint of a node differs from its earlier state; `None` if that is not known.
pub(crate) fn changed_tiles(
    surface: &SourceSurface<'_>,
    strokes: &Strokes,
    graph: &Path,
    [before, now]: [&SourceStep; 2],
    warnings: &mut Vec<String>,
) -> Option<TileSet> {
    let text = |step: &SourceStep| step.values.text("strokes").ok().map(str::to_owned);
    let (old, new) = (text(before)?, text(now)?);
    if !is_painted_on(before, now) {
        return None;
    }
    let layers = now.writes.iter().fold(CanvasLayers::default(), |layers, (output, _)| {
        layers.and(PaintOutput::named(output).layers())
    });
    if strokes.copy_input(graph, &surface.model.stem, &new) {
        return None;
    }
    canvas(surface, strokes, graph, &now.id, &new, layers, None, warnings)?;
    let version = strokes.find(graph, &surface.model.stem, &new).version()?;
    let place = PaintedNodePlace {
        surface_key: surface.key,
        node: now.id.clone(),
    };
    let texels = strokes.changed_texels(&place, Strokes::first_version(&old), version)?;
    let tile = |texel: &u32| tile_of(*texel, surface.atlas.page_size);
    Some(TileSet::new(texels.iter().map(tile)))
}

/// Returns the canvas of a node; `None` if nothing is painted on this model.
fn canvas(
    surface: &SourceSurface<'_>,
    strokes: &Strokes,
    graph: &Path,
    node: &str,
    written: &str,
    layers: CanvasLayers,
    from: Option<&PlaneData>,
    warnings: &mut Vec<String>,
) -> Option<Arc<Canvas>> {
    let model = &surface.model.stem;
    let found = strokes.find(graph, model, written);
    let mut warn = |why: String| {
        let why = format!("node '{node}' ({NAME}) {why}");
        if !warnings.contains(&why) {
            warnings.push(why);
        }
    };
    for fault in strokes.faults(graph) {
        warn(format!("lacks strokes: {fault}"));
    }
    let version = match &found {
        StrokeSearch::Strokes(version) => *version,
        StrokeSearch::Nothing => return None,
        StrokeSearch::Missing | StrokeSearch::OtherModels(_) => {
            warn(why_empty(&found, graph, model));
            return None;
        }
    };
    if from.is_none() && strokes.copy_input(graph, model, written) {
        let why = "has strokes that copy from another node, and nothing is connected to From: connect a node to it, or remove them";
        warn(why.to_owned());
    }
    for picture in strokes.missing_pictures(graph, version) {
        let folder = picture_folder(&paint_folder(graph));
        warn(format!(
            "lacks the picture {picture} of a brush: put it into {}",
            folder.display()
        ));
    }
    let painted = strokes.painted(surface, graph, node, version, layers, from)?;
    if !painted.lost.is_empty() {
        let count: usize = painted.lost.values().sum();
        let which = strokes.lost_places(version, &painted.lost);
        warn(format!(
            "lost {count} places of its strokes: the model has no surface near them any more ({which})"
        ));
    }
    Some(painted.canvas)
}

/// Returns the reason why a node without strokes for this model is empty, as the end of a sentence.
fn why_empty(found: &StrokeSearch, graph: &Path, model: &str) -> String {
    if let StrokeSearch::OtherModels(others) = found {
        return format!("is empty on '{model}': it was painted on {}", others.join(", "));
    }
    let folder = paint_folder(graph);
    format!(
        "is empty: its strokes are not in {}; put that folder beside the graph again",
        folder.display()
    )
}
