//! `pack_graph`: everything that a bake of a graph reads, in one archive.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_files::archive::{EntryContent, write_archive};
use sabi_files::{TrustedPaths, Unread, canonical, named_path, whole_path};
use sabi_graph::Value;
use schemars::JsonSchema;
use serde::Serialize;

use super::archive_check::check;
use super::manifest::{self, ArchiveManifest};
use super::model_files::ModelFiles;
use super::named_files::NamedDocument;
use super::needs::Needs;
use super::own_nodes::own_nodes;
use super::places::Places;
use super::rewritten_paths::{RewrittenDocument, ShownModel, rewritten};
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::opening::linked_model::{ModelOptions, SavedReading};
use crate::phases::{Progress, unless_canceled};
use crate::remedy::Remedy;
use crate::source::paint::NAME as PAINT;
use crate::source::strokes::{files_beside, paint_folder};

/// Ending of graphs in an archive.
const ENDING: &str = ".sabi";

/// Request to pack a graph.
#[derive(Clone, Debug)]
pub struct PackRequest {
    /// Graph file.
    pub graph: PathBuf,
    /// Model that goes into the archive.
    pub model: PackedModel,
    /// Parts of the model that are used, and faces that are turned, for the graph in the archive. Where this has no value,
    /// the graph's choice for this model is used.
    pub reading: SavedReading,
    /// The archive.
    pub output: PathBuf,
    /// True to pack without missing files, each of which becomes a warning.
    pub allows_missing: bool,
    /// Replaces an archive that exists.
    pub replaces: bool,
    /// Paths from which the graph and the model may open the files that they name, in addition to their own folders and projects.
    pub trusted: TrustedPaths,
}

/// Model that goes into an archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PackedModel {
    /// The one that the graph names.
    OfGraph,
    /// This file.
    File(PathBuf),
    /// None.
    None,
}

/// An archive that was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct PackReport {
    /// Path of the archive as it was given.
    pub archive: String,
    /// The graph in it.
    pub graph: String,
    /// The model in it.
    pub model: Option<String>,
    /// Its files, sorted by name.
    pub files: Vec<PackedFile>,
    /// Sentences about files that are missing.
    pub missing: Vec<String>,
    /// Other warnings.
    pub warnings: Vec<String>,
}

/// A file of an archive.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct PackedFile {
    /// Name in the archive.
    pub name: String,
    /// Size unpacked, bytes.
    pub bytes: u64,
    /// The original file, if it is outside of the graph's folder.
    pub from: Option<String>,
}

/// Everything that was found for an archive.
struct ArchiveContent {
    needs: Needs,
    model: Option<ModelFiles>,
    reading: SavedReading,
    /// Node files by their names in the archive.
    nodes: BTreeMap<String, PathBuf>,
    warnings: Vec<String>,
}

/// Packs a graph with all that a bake of it reads into one archive: files below its folder keep their places, others go into a folder of
/// their own, and the copies of the documents name them there. No file but the archive is written. The same files give the same bytes.
///
/// # Errors
/// A file cannot be read or packed, is missing and that is not allowed, or the archive exists or cannot be written; nothing is left
/// behind.
pub fn pack_graph(request: &PackRequest, progress: &dyn Progress) -> Result<PackReport, EngineError> {
    let (open, kinds) = OpenGraph::open_with_kinds(request.graph.clone(), request.trusted.clone(), progress)?;
    let found = ArchiveContent::of(open, &kinds, request, progress)?;
    if !found.needs.missing.is_empty() && !request.allows_missing {
        let refused = EngineError::several(ErrorKind::MissingInput, found.needs.missing);
        return Err(refused.with_remedies([Remedy::WithoutMissingFiles]));
    }
    let (places, model) = found.places()?;
    places.check_files()?;
    refuse_input(&request.output, &places)?;
    let documents = found.rewritten(&places, model.as_deref());
    check(&found.needs.documents[0], &documents, &places, &kinds)?;
    let graph = documents[0].name.clone();
    let manifest = ArchiveManifest::new(graph.clone(), model.clone()).bytes();
    let manifest = manifest.map_err(|error| EngineError::of(ErrorKind::Defect, error))?;
    let files = places.files().iter();
    let mut entries: BTreeMap<String, EntryContent> = files
        .map(|(name, path)| (name.clone(), EntryContent::File(path.clone())))
        .collect();
    for document in documents {
        entries.insert(document.name, EntryContent::Bytes(document.text.into_bytes()));
    }
    entries.insert(manifest::NAME.to_owned(), EntryContent::Bytes(manifest));
    let sizes = write_archive(&request.output, &entries, request.replaces, &|| progress.is_canceled())?;
    let origin = |name: &String| {
        let path = places.files().get(name).filter(|path| places.is_outside(path));
        path.map(|path| path.display().to_string())
    };
    Ok(PackReport {
        archive: request.output.display().to_string(),
        graph,
        model,
        files: entries
            .keys()
            .zip(sizes)
            .map(|(name, bytes)| PackedFile {
                from: origin(name),
                name: name.clone(),
                bytes,
            })
            .collect(),
        missing: found.needs.missing,
        warnings: found.warnings,
    })
}

impl ArchiveContent {
    fn of(
        open: OpenGraph,
        kinds: &Kinds,
        request: &PackRequest,
        progress: &dyn Progress,
    ) -> Result<ArchiveContent, EngineError> {
        let folders = Kinds::folders(Some(&open.path));
        let mut needs = Needs::of(open, kinds)?;
        let (nodes, without_file) = own_nodes(kinds, &folders, &needs.documents);
        needs.missing.extend(without_file);
        let mut warnings = Vec::new();
        for document in &needs.documents {
            look_for_strokes(document, &mut needs.missing, &mut warnings);
        }
        let (model, reading) = model_of(&needs.documents[0], request, &mut needs.missing, progress)?;
        Ok(ArchiveContent {
            needs,
            model,
            reading,
            nodes,
            warnings,
        })
    }

    /// Assigns names in the archive to all files, and returns the model's.
    fn places(&self) -> Result<(Places, Option<String>), EngineError> {
        let [graph, groups @ ..] = self.needs.documents.as_slice() else {
            return Err(EngineError::new(ErrorKind::Defect, "a graph is no document"));
        };
        let root = graph.path.parent().unwrap_or(Path::new("")); // A file has a folder.
        let mut places = Places::new(root)?;
        let name = graph.path.file_name().and_then(|name| name.to_str()).ok_or_else(|| {
            let why = format!(
                "{} cannot be packed, because its name is not Unicode text; rename it",
                graph.path.display()
            );
            EngineError::new(ErrorKind::BadInput, why)
        })?;
        let name = match name.strip_suffix(ENDING) {
            Some(_) => name.to_owned(),
            // With the same stem, the graph finds its strokes.
            None => format!("{}{ENDING}", name.rsplit_once('.').map_or(name, |(stem, _)| stem)),
        };
        // Names that files must have are assigned before those that can be chosen.
        places.take_as(&graph.path, &name)?;
        take_strokes(graph, &mut places)?;
        for (name, path) in &self.nodes {
            let folders = Kinds::folders(Some(&graph.path));
            let own = folders.iter().find(|folder| path.starts_with(folder));
            let trusted = &graph.open.trusted;
            let trusted = own.map(|folder| Kinds::trusted_for(folder, trusted));
            refuse_link(path, trusted.as_ref().unwrap_or(&graph.open.trusted))?;
            places.take_as(&named_path(path), name)?;
        }
        let model = self.model.as_ref().map(|model| places.take_model(model)).transpose()?;
        for group in groups {
            places.take(&group.path)?;
            take_strokes(group, &mut places)?;
        }
        for picture in &self.needs.pictures {
            places.take(picture)?;
        }
        Ok((places, model))
    }

    /// Returns the documents with the paths of the archive, the graph first.
    fn rewritten(&self, places: &Places, model: Option<&str>) -> Vec<RewrittenDocument> {
        let documents = self.needs.documents.iter().enumerate();
        let named = documents.filter_map(|(index, document)| Some((index, document, places.of(&document.path)?)));
        named
            .map(|(index, document, name)| match index {
                0 => rewritten(document, name, places, &ShownModel::Interface(model, &self.reading)),
                _ => rewritten(document, name, places, &ShownModel::AsWritten),
            })
            .collect()
    }
}

/// Returns the model of a pack with the files that it names (`None` if it is missing), and the choices for reading it.
fn model_of(
    graph: &NamedDocument,
    request: &PackRequest,
    missing: &mut Vec<String>,
    progress: &dyn Progress,
) -> Result<(Option<ModelFiles>, SavedReading), EngineError> {
    let (model, asked) = (&request.model, &request.reading);
    let kept = || {
        let preview = graph.open.document.preview.as_ref();
        preview.map_or_else(SavedReading::default, |preview| asked.or(preview, &graph.base()))
    };
    let shown = graph.open.path.display();
    let mut trusted = graph.open.trusted.clone();
    let path = match model {
        PackedModel::None => return Ok((None, kept())),
        PackedModel::File(path) => {
            trusted = trusted.with_file(path);
            named_path(path)
        }
        PackedModel::OfGraph => {
            let preview = graph.open.document.preview.as_ref();
            if preview.is_some_and(|preview| preview.builtin_mesh().is_some()) {
                // It comes with the program that the archive is opened with.
                return Ok((None, kept()));
            }
            let Some(written) = preview.and_then(|preview| preview.mesh.as_deref()) else {
                let refused = EngineError::new(ErrorKind::Usage, format!("{shown}: the graph names no model"));
                return Err(refused.with_remedies([Remedy::NameModel, Remedy::WithoutModel]));
            };
            if let Err(Unread::Refused(refusal)) = trusted.check(&graph.base(), written) {
                let refused = EngineError::refused(&refusal);
                return Err(refused.map_messages(|why| format!("{shown}: {why}")));
            }
            let path = whole_path(&graph.base(), written);
            if !path.exists() {
                missing.push(format!(
                    "{shown}: the graph is shown on the model {}, which is missing",
                    path.display()
                ));
                return Ok((None, kept()));
            }
            path
        }
    };
    let options = ModelOptions {
        reading: asked.clone(),
        ..ModelOptions::new(&path, 0)
    };
    let reading = options.for_graph(&graph.open).reading;
    let (read, own) = (path.clone(), reading.clone());
    let files = unless_canceled(progress, move || ModelFiles::read(&read, &trusted, &own))??;
    let lacks = files.missing.iter();
    missing.extend(lacks.map(|named| format!("the model {} names {named}, which is missing", path.display())));
    Ok((Some(files), reading))
}

/// Reports missing strokes of a document.
fn look_for_strokes(document: &NamedDocument, missing: &mut Vec<String>, warnings: &mut Vec<String>) {
    let strokes = &document.open.strokes;
    let painted = document.nodes().filter(|(_, node)| node.kind == PAINT);
    for (words, node) in painted {
        let Some(Value::Text(versions)) = node.params.get("strokes") else {
            continue;
        };
        strokes.read_beside(&document.path);
        for (folder, lacking) in strokes.lacking(&document.path, versions) {
            missing.push(format!(
                "{words} lacks {lacking}, which should be in {}",
                folder.display()
            ));
        }
    }
    warnings.extend(strokes.faults(&document.path));
}

/// Assigns names to the strokes of a document, beside it.
fn take_strokes(document: &NamedDocument, places: &mut Places) -> Result<(), EngineError> {
    if !document.nodes().any(|(_, node)| node.kind == PAINT) {
        return Ok(());
    }
    let Some(name) = places.of(&document.path).map(Path::new) else {
        return Ok(());
    };
    let beside = paint_folder(name).to_string_lossy().replace('\\', "/");
    let folder = paint_folder(&document.path);
    let own = TrustedPaths::default().with_path(document.base().folder());
    for file in files_beside(&document.path) {
        let path = folder.join(&file);
        refuse_link(&path, &own)?;
        places.take_as(&path, &format!("{beside}/{file}"))?;
    }
    Ok(())
}

/// Refuses a file that was found without being named, if links lead out of the trusted paths: it must not be sent along.
fn refuse_link(path: &Path, trusted: &TrustedPaths) -> Result<(), EngineError> {
    match trusted.check_found(path) {
        Err(Unread::Refused(refusal)) => {
            let refused = EngineError::refused(&refusal);
            let shown = path.display();
            let told = refused.map_messages(|why| format!("{shown} is a link: {why}; copy the file into its place"));
            Err(told.with_remedies([]))
        }
        // A missing file is told elsewhere.
        _ => Ok(()),
    }
}

/// Refuses an archive that would replace a file which goes into it.
fn refuse_input(output: &Path, places: &Places) -> Result<(), EngineError> {
    let Ok(output) = canonical(output) else { return Ok(()) };
    if places
        .files()
        .values()
        .all(|input| canonical(input).ok().as_ref() != Some(&output))
    {
        return Ok(());
    }
    let why = format!(
        "cannot write the archive {}: it is packed itself; name another file",
        output.display()
    );
    Err(EngineError::new(ErrorKind::CannotWrite, why))
}
