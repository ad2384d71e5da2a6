//! A graph that is evaluated, with the kinds and files that it names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_files::{PathBase, TrustedPaths};
use sabi_graph::{Fit, FlatGraph, FlatNode};
use sabi_nodes::kind::Shape;
use sabi_plan::{FileContents, Target};
use sabi_surface::model::Model;

use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::source::session_pictures::{SessionPictures, files};
use crate::source::strokes::Strokes;
use crate::source::{Files, SOURCE_MODEL, paint};

/// Flat graph with its node kinds and pictures.
pub(crate) struct EvaluatedGraph {
    /// Graph file, as it was named.
    path: PathBuf,
    flat: FlatGraph,
    /// All node kinds, with those of the model's content adapted to the model.
    kinds: Kinds,
    pictures: SessionPictures,
    strokes: Strokes,
    trusted: TrustedPaths,
    /// Memory limit in bytes for the pictures of the model, and for each picture of the graph.
    memory_bytes: u64,
}

impl EvaluatedGraph {
    /// Creates the graph. `flat` is the flattened document of `open`. The pictures of the model take at most `memory_bytes`.
    pub(crate) fn new(
        open: &OpenGraph,
        flat: FlatGraph,
        kinds: Kinds,
        model: &Model,
        memory_bytes: u64,
    ) -> EvaluatedGraph {
        let mut graph = EvaluatedGraph {
            path: open.path.clone(),
            flat,
            kinds,
            pictures: open.pictures.clone(),
            strokes: open.strokes.clone(),
            trusted: open.trusted.clone(),
            memory_bytes,
        };
        graph.kinds.adapt_to(model);
        graph.pictures.keep_at_most(memory_bytes);
        graph
    }

    /// Replaces the graph; `flat` is the flattened document of `open`.
    pub(crate) fn set(&mut self, open: &OpenGraph, flat: FlatGraph) {
        self.path.clone_from(&open.path);
        self.pictures = open.pictures.clone();
        self.strokes = open.strokes.clone();
        self.trusted.clone_from(&open.trusted);
        self.flat = flat;
    }

    /// Replaces the flat graph alone.
    pub(crate) fn set_flat(&mut self, flat: FlatGraph) {
        self.flat = flat;
    }

    /// Replaces the node kinds, for example after node files were read again.
    pub(crate) fn set_kinds(&mut self, kinds: Kinds, model: &Model) {
        self.kinds = kinds;
        self.kinds.adapt_to(model);
    }

    /// Appends a node of the model's own materials. Its index is the previous number of nodes.
    pub(crate) fn append_model_source(&mut self, fit: Fit) {
        self.flat.nodes.push(model_source_node(fit));
    }

    /// Appends nodes. The index of the first is the previous number of nodes.
    pub(crate) fn append(&mut self, nodes: Vec<FlatNode>) {
        self.flat.nodes.extend(nodes);
    }

    pub(crate) fn flat(&self) -> &FlatGraph {
        &self.flat
    }

    pub(crate) fn kinds(&self) -> &Kinds {
        &self.kinds
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the base that resolves paths in the graph.
    fn base(&self) -> PathBase {
        PathBase::of_file(&self.path)
    }

    /// Returns access to the files that nodes name.
    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            pictures: &self.pictures,
            strokes: &self.strokes,
            path: &self.path,
            base: self.base(),
            trusted: &self.trusted,
            memory_bytes: self.memory_bytes,
            graph: &self.flat,
        }
    }

    /// Returns the contents of the files that the targets need: of pictures, and of strokes on this model.
    pub(crate) fn contents(&self, targets: &[Target], model: &Model) -> FileContents {
        let nodes: Vec<usize> = targets.iter().map(|target| target.node).collect();
        let wanted: Vec<usize> = self.flat.upstream(&nodes).into_iter().collect();
        let files = self.files();
        let strokes = wanted.iter().filter_map(|index| {
            let node = self.flat.nodes.get(*index)?;
            Some((*index, Ok(paint::content(&files, node, model)?)))
        });
        let strokes: FileContents = strokes.collect();
        let pictures = self.pictures.contents(
            &self.base(),
            &self.trusted,
            &self.flat,
            &self.kinds.sources,
            wanted,
            self.memory_bytes,
        );
        pictures.into_iter().chain(strokes).collect()
    }

    /// Returns true if any node is a filter or shoots rays, which may run on coarser levels of the atlas.
    pub(crate) fn has_filters(&self) -> bool {
        let is_filter = |node: &FlatNode| {
            let kind = self.kinds.library.kind(&node.kind);
            kind.is_some_and(|kind| kind.shape == Shape::Field || kind.rays.iter().any(|rays| rays.texel.is_some()))
        };
        self.flat.nodes.iter().any(is_filter)
    }

    /// Lists the files of the graph: its own, its groups and its pictures.
    pub(crate) fn read_files(&self, open: &OpenGraph) -> Vec<PathBuf> {
        let base = open.base();
        let groups = self
            .flat
            .nodes
            .iter()
            .filter_map(|node| node.file.as_ref())
            .map(|file| base.resolve(file));
        let named = files(&base, &open.trusted, &self.flat, &self.kinds.sources);
        let own = std::iter::once(open.path.clone()).chain(groups);
        own.chain(named).collect()
    }

    /// Drops the decoded pictures. They are read again when they are needed.
    pub(crate) fn forget_pictures(&self) {
        self.pictures.clear();
    }
}

/// Creates a node of the model's own materials. Its id is not valid in a graph file.
pub(crate) fn model_source_node(fit: Fit) -> FlatNode {
    FlatNode {
        id: "(model)".to_owned(),
        kind: SOURCE_MODEL.to_owned(),
        version: 1,
        params: BTreeMap::new(),
        inputs: BTreeMap::new(),
        muted: false,
        seeds: Vec::new(),
        length_scale: 1.0,
        fit,
        file: None,
    }
}
