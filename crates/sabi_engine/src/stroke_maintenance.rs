//! Maintenance of the strokes beside a graph: `sabi paint flatten` and `sabi paint reproject`.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use sabi_graph::{Body, Edit, NodeId, Value};
use sabi_paint::{PaintSurface, Step, Stroke, StrokeList, SurfaceIndex, relocate};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{EngineError, ErrorKind};
use crate::opening::linked_model::{LinkedModel, ModelOptions};
use crate::phases::NoProgress;
use crate::remedy::Remedy;
use crate::session::Session;
use crate::source::paint::NAME;
use crate::source::strokes::{FlattenedFile, FlattenedStrokes, title};

/// Strokes of a graph before and after they were flattened.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FlattenReport {
    /// Files of strokes.
    pub files: Vec<FlattenedFile>,
}

/// Strokes that were moved to another model.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ReprojectReport {
    /// Model on which they were painted.
    pub from: String,
    /// Model that they were laid on.
    pub to: String,
    /// Strokes that were laid.
    pub strokes: usize,
    /// Their places.
    pub points: usize,
    /// Strokes that lost places: node, number of the stroke from the lowest, 1 on, or its name, and the places of it that the
    /// model has no surface near.
    pub lost: Vec<LostStroke>,
}

/// A stroke that lost places.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LostStroke {
    /// Paint node.
    pub node: String,
    /// Name of the stroke, or its number from the lowest.
    pub stroke: String,
    /// Places that were lost.
    pub lost: usize,
    /// All its places.
    pub points: usize,
}

/// A paint node, and the versions that it names.
struct PaintNode {
    body: Body,
    node: NodeId,
    versions: String,
}

/// Rewrites the files of strokes beside a graph without their history: undone and removed strokes and earlier states are dropped, and
/// the graph names the new versions. The files as they were are kept beside them, with `.bak` behind their names. With `is_trial`
/// nothing is written.
///
/// # Errors
/// The graph or a file cannot be read or written, or strokes are missing or damaged; what is on disk then still belongs together.
pub fn flatten_strokes(graph: &Path, is_trial: bool) -> Result<FlattenReport, EngineError> {
    let mut session = opened(graph)?;
    let strokes = session.graph().strokes.clone();
    let mut edits = Vec::new();
    let mut flattened: BTreeMap<String, FlattenedStrokes> = BTreeMap::new();
    for PaintNode { body, node, versions } in paint_nodes(&session) {
        let after = strokes.flattened(&versions, &mut flattened).map_err(|why| {
            EngineError::new(
                ErrorKind::MissingInput,
                format!("{}: node '{node}' {why}", graph.display()),
            )
        })?;
        edits.push(versions_edit(body, node, after));
    }
    let report = FlattenReport {
        files: strokes.file_sizes(graph, &flattened),
    };
    if is_trial {
        return Ok(report);
    }
    // The graph finds its strokes at every moment: the files are copied, new versions are added and then named, and then
    // the old ones are removed.
    let cannot = |why: String| EngineError::new(ErrorKind::CannotWrite, why);
    strokes.copy_files(graph, &flattened).map_err(cannot)?;
    let named: Vec<String> = flattened.values().map(FlattenedStrokes::versions).collect();
    strokes.store(graph, &named.join(" ")).map_err(cannot)?;
    apply(&mut session, "Flatten strokes", edits)?;
    session.save()?;
    strokes.replace_files(graph, &flattened).map_err(cannot)?;
    Ok(report)
}

/// Lays the strokes that were painted on one model on another one, or on an edited one of the same name: each place by the same rule as
/// when it is painted. `from` is the model that they were painted on; none for the one with the name of the other, or the only one. With
/// `replaces`, strokes that a node has on the other model already are replaced.
///
/// # Errors
/// The graph, its strokes or the model cannot be read or written, nothing is painted on `from`, or a node would lose all of its strokes,
/// or those on the other model; nothing is changed then.
pub fn reproject_strokes(
    graph: &Path,
    model: &ModelOptions,
    from: Option<&str>,
    replaces: bool,
) -> Result<ReprojectReport, EngineError> {
    let mut session = opened(graph)?;
    let strokes = session.graph().strokes.clone();
    let model = LinkedModel::load_model(model, &NoProgress)?;
    let index = SurfaceIndex::new(&model.mesh);
    let surface = PaintSurface::new(&model.mesh, &index);
    let nodes = paint_nodes(&session);
    let all: Vec<&str> = nodes.iter().map(|node| node.versions.as_str()).collect();
    let from = source_model(&strokes.models_of(&all.join(" ")), &model.stem, from)
        .map_err(|why| EngineError::new(ErrorKind::MissingInput, format!("{}: {why}", graph.display())))?;
    let mut report = ReprojectReport {
        from: from.clone(),
        to: model.stem.clone(),
        strokes: 0,
        points: 0,
        lost: Vec::new(),
    };
    let mut edits = Vec::new();
    for PaintNode { body, node, versions } in nodes {
        let Some(list) = strokes.on_model(graph, &from, &versions) else {
            continue;
        };
        let laid = laid_again(&surface, &list, &node, &mut report.lost);
        let has_own = || {
            strokes
                .on_model(graph, &model.stem, &versions)
                .is_some_and(|own| !own.strokes.is_empty())
        };
        let would_drop = from != model.stem && !replaces && has_own();
        if let Some(refusal) = refusal(&laid, &list, &model.stem, would_drop) {
            let refusal = refusal.map_messages(|why| format!("{}: node '{node}' {why}", graph.display()));
            return Err(refusal);
        }
        report.strokes += laid.len();
        let after = strokes.painted_anew(&model.stem, &versions, &laid, &mut report.points);
        edits.push(versions_edit(body, node, after));
    }
    apply(&mut session, "Lay strokes on another model", edits)?;
    session.keep_strokes()?;
    session.save()?;
    Ok(report)
}

/// Returns steps that move the strokes of a node to another surface. Adds the strokes that lose points.
fn laid_again(
    surface: &PaintSurface<'_>,
    list: &StrokeList,
    node: &NodeId,
    lost_strokes: &mut Vec<LostStroke>,
) -> Vec<Step> {
    let mut laid = Vec::new();
    for (index, stroke) in list.strokes.iter().enumerate() {
        let (found, lost) = relocate(surface, stroke);
        if lost > 0 {
            lost_strokes.push(LostStroke {
                node: node.to_string(),
                stroke: title(stroke, index, list.strokes.len()),
                lost,
                points: stroke.points.len(),
            });
        }
        if !found.points.is_empty() || stroke.points.is_empty() {
            laid.push(Step::Add(Arc::new(keyed(surface, found))));
        }
    }
    laid
}

/// Returns the reason why the strokes of a node are not moved to a model; `None` if they can be moved.
fn refusal(laid: &[Step], list: &StrokeList, model: &str, would_drop: bool) -> Option<EngineError> {
    let refused = |why: String| EngineError::new(ErrorKind::BadInput, why);
    if laid.is_empty() && !list.strokes.is_empty() {
        let count = list.strokes.len();
        return Some(refused(format!(
            "would lose all of its {count} strokes, since no place of them lies near the surface of '{model}'; nothing was changed. Is \
             the model in the same units and place?"
        )));
    }
    would_drop.then(|| {
        let why = format!("was painted on '{model}' already, and these strokes would be lost; nothing was changed");
        refused(why).with_remedies([Remedy::ReplaceStrokes])
    })
}

/// Opens a session of a graph file with all strokes beside it.
fn opened(graph: &Path) -> Result<Session, EngineError> {
    let session = Session::open(graph, None)?;
    let strokes = &session.graph().strokes;
    strokes.read_beside(graph);
    match strokes.faults(graph).first() {
        Some(fault) => {
            let why = format!("{fault}; repair it from a copy, or move it away, before its strokes are rewritten");
            Err(EngineError::new(ErrorKind::BadInput, why))
        }
        None => Ok(session),
    }
}

/// Paint nodes of a graph and of the groups in it.
fn paint_nodes(session: &Session) -> Vec<PaintNode> {
    let document = session.document();
    let groups = document
        .groups
        .iter()
        .map(|(name, group)| (Body::Group(name.clone()), &group.graph));
    let bodies = std::iter::once((Body::Main, &document.graph)).chain(groups);
    let nodes = bodies.flat_map(|(body, graph)| graph.nodes().map(move |node| (body.clone(), node)));
    let paint = nodes.filter(|(_, (_, node))| node.kind == NAME);
    let named = paint.filter_map(|(body, (id, node))| match node.params.get("strokes") {
        Some(Value::Text(versions)) if !versions.trim().is_empty() => Some(PaintNode {
            body,
            node: id.clone(),
            versions: versions.clone(),
        }),
        _ => None,
    });
    named.collect()
}

fn versions_edit(body: Body, node: NodeId, versions: String) -> Edit {
    Edit::SetParam {
        body,
        node,
        param: "strokes".to_owned(),
        value: Some(Value::Text(versions)),
    }
}

fn apply(session: &mut Session, name: &str, edits: Vec<Edit>) -> Result<(), EngineError> {
    for edit in edits {
        session
            .edit(name, edit)
            .map_err(|error| EngineError::new(ErrorKind::BadInput, error.to_string()))?;
    }
    Ok(())
}

/// Returns the model whose strokes are moved to another one.
fn source_model(painted: &[String], target: &str, named: Option<&str>) -> Result<String, String> {
    let list = painted.join(", ");
    match (named, painted) {
        (Some(name), _) if painted.iter().any(|model| model == name) => Ok(name.to_owned()),
        (_, []) => Err("nothing is painted in this graph".to_owned()),
        (Some(name), _) => Err(format!("nothing is painted on '{name}'; strokes are on {list}")),
        (None, _) if painted.iter().any(|model| model == target) => Ok(target.to_owned()),
        (None, [only]) => Ok(only.clone()),
        (None, _) => Err(format!(
            "strokes are on {list}: say which of these models they come from"
        )),
    }
}

/// Returns the stroke with the triangle keys of this surface.
fn keyed(surface: &PaintSurface<'_>, stroke: Stroke) -> Stroke {
    let points = stroke.points.iter();
    let keyed = points.filter_map(|point| surface.point(point.site, point.touch(), point.starts));
    Stroke {
        points: keyed.collect(),
        ..stroke.clone()
    }
}
