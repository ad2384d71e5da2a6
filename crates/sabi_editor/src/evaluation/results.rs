//! Newest results of the evaluation.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use egui::{ColorImage, Context, TextureHandle, TextureOptions};
use glam::{DVec3, Vec3};
use sabi_editing::{OpenDocument, node_paths};
use sabi_engine::evaluating::ModelLooks;
use sabi_engine::live::{InspectedResult, LiveModel, LiveTimes, ViewSubject};
use sabi_graph::NodeRef;
use sabi_view::Pixels;

use super::WantedResults;

/// Results on the model that are kept besides the wanted ones, since artists switch back to results that they have just
/// seen.
const KEPT_PICTURES: usize = 6;

/// Maps of one result on the model.
#[derive(Clone)]
pub(crate) struct ResultPicture {
    pub(crate) model: Arc<LiveModel>,
    pub(crate) looks: Arc<ModelLooks>,
    /// Full id of the output that gives each material of the model, by index; materials that no output gives are missing.
    pub(crate) outputs: Arc<BTreeMap<u32, String>>,
    /// Rises with every picture.
    pub(crate) number: u64,
    /// Earlier pictures of the same model by their numbers. Outside of the boxes of each, which are in view space, this
    /// picture looks the same as that one.
    pub(crate) changed: Vec<(u64, Vec<[Vec3; 2]>)>,
}

/// Earlier pictures that a picture remembers: as many as may come between two frames.
const EARLIER: usize = 8;

/// Lists the previous picture and the earlier pictures listed with it, by their numbers. The boxes of each, in view
/// space, contain everything that looks different in the newer picture.
fn changed_since(before: &ResultPicture, picture: &ResultPicture) -> Vec<(u64, Vec<[Vec3; 2]>)> {
    let identities = before.looks.identity.as_ref().zip(picture.looks.identity.as_ref());
    let since = identities.and_then(|(old, new)| new.since.as_ref().filter(|(key, _)| *key == old.key));
    let Some((_, bounds)) = since.filter(|_| Arc::ptr_eq(&before.model, &picture.model)) else {
        return Vec::new();
    };
    let placement = &picture.model.placement;
    let in_view = |place: DVec3| ((place - DVec3::from(placement.center)) * placement.scale).as_vec3();
    let bounds: Vec<[Vec3; 2]> = bounds.iter().map(|corners| corners.map(in_view)).collect();
    let earlier = before.changed.iter().map(|(number, boxes)| {
        let together = boxes.iter().chain(&bounds).copied().collect();
        (*number, together)
    });
    std::iter::once((before.number, bounds.clone()))
        .chain(earlier)
        .take(EARLIER)
        .collect()
}

/// Newest results.
#[derive(Default)]
pub(crate) struct EvaluationResults {
    pictures: BTreeMap<ViewSubject, ResultPicture>,
    /// Number of the last picture.
    last_number: u64,
    thumbnails: BTreeMap<NodeRef, (TextureHandle, Pixels)>,
    /// Result that the 2D view shows, with its values.
    pub(crate) inspected: Option<(NodeRef, Arc<InspectedResult>)>,
    /// Revision of the model since which the file of these values is the same.
    pub(super) inspected_since: u64,
    /// Result whose histogram is shown among parameters, with its values.
    pub(crate) measured: Option<(NodeRef, Arc<InspectedResult>)>,
    /// Last values that arrived after another result was requested. The engine does not send them again while they are
    /// unchanged.
    unwanted: Option<(NodeRef, Arc<InspectedResult>)>,
    times: BTreeMap<String, Duration>,
    /// Times and memory of the last evaluation.
    pub(crate) last: LiveTimes,
}

impl EvaluationResults {
    /// Reuses values between the 2D view and the histogram among parameters, since the engine sends unchanged values
    /// only once.
    pub(super) fn share_values(&mut self, wanted: &WantedResults) {
        let values_of = |wanted: &Option<NodeRef>, known: &Option<(NodeRef, Arc<InspectedResult>)>| {
            known.clone().filter(|(node, _)| Some(node) == wanted.as_ref())
        };
        let held = [&self.measured, &self.inspected, &self.unwanted];
        let measured = held.iter().find_map(|known| values_of(&wanted.measured, known));
        let held = [&self.inspected, &self.measured, &self.unwanted];
        let inspected = held.iter().find_map(|known| values_of(&wanted.inspected, known));
        if inspected.is_some() {
            self.inspected = inspected;
        }
        self.measured = measured;
    }

    /// Takes values that arrived. Returns whether they are those of the 2D view.
    pub(super) fn take_values(
        &mut self,
        wanted: Option<&WantedResults>,
        node: NodeRef,
        values: Arc<InspectedResult>,
    ) -> bool {
        let is_wanted = |of: fn(&WantedResults) -> &Option<NodeRef>| {
            wanted.is_some_and(|wanted| of(wanted).as_ref() == Some(&node))
        };
        let is_inspected = is_wanted(|wanted| &wanted.inspected);
        let is_measured = is_wanted(|wanted| &wanted.measured);
        let arrived = Some((node, values));
        if is_measured {
            self.measured = arrived.clone();
        }
        if is_inspected {
            self.inspected = arrived;
        } else if !is_measured {
            self.unwanted = arrived;
        }
        is_inspected
    }
}

/// Results that were dropped, which the engine evaluates again when they are wanted.
pub(super) struct DroppedResults {
    pub(super) subjects: Vec<ViewSubject>,
    pub(super) thumbnails: Vec<NodeRef>,
}

impl EvaluationResults {
    /// Adds a picture, with a number of its own.
    pub(super) fn add_picture(&mut self, subject: ViewSubject, picture: ResultPicture) {
        self.last_number += 1;
        let number = self.last_number;
        let before = self.pictures.get(&subject);
        let changed = before.map_or_else(Vec::new, |before| changed_since(before, &picture));
        let picture = ResultPicture {
            number,
            changed,
            ..picture
        };
        self.pictures.insert(subject, picture);
    }

    pub(super) fn add_thumbnail(&mut self, context: &Context, node: NodeRef, picture: Pixels) {
        let size = picture.size.map(|side| side as usize);
        let image = ColorImage::from_rgba_unmultiplied(size, &picture.rgba);
        match self.thumbnails.get_mut(&node) {
            Some((handle, known)) => {
                handle.set(image, TextureOptions::LINEAR);
                *known = picture;
            }
            None => {
                let handle = context.load_texture(format!("result of {}", node.node), image, TextureOptions::LINEAR);
                self.thumbnails.insert(node, (handle, picture));
            }
        }
    }

    pub(super) fn add_times(&mut self, times: LiveTimes) {
        self.times.extend(times.nodes.iter().cloned());
        self.last = times;
    }

    /// Newest maps of a result, if any have arrived.
    pub(crate) fn picture(&self, subject: &ViewSubject) -> Option<&ResultPicture> {
        self.pictures.get(subject)
    }

    pub(crate) fn thumbnail(&self, node: &NodeRef) -> Option<&TextureHandle> {
        self.thumbnails.get(node).map(|(handle, _)| handle)
    }

    /// Pixels of a thumbnail.
    pub(crate) fn thumbnail_pixels(&self, node: &NodeRef) -> Option<&Pixels> {
        self.thumbnails.get(node).map(|(_, picture)| picture)
    }

    /// Time of a node's last evaluation; of a group instance, that of all nodes in it.
    pub(crate) fn time(&self, node: &str) -> Option<Duration> {
        let inner = format!("{node}/");
        let inside = self.times.range(inner.clone()..);
        let inside = inside
            .take_while(|(id, _)| id.starts_with(&inner))
            .map(|(_, time)| *time);
        let own = self.times.get(node).copied();
        own.into_iter().chain(inside).reduce(|sum, time| sum + time)
    }

    /// Time of each node's last evaluation.
    pub(crate) fn times(&self) -> &BTreeMap<String, Duration> {
        &self.times
    }

    /// Numbers of held results on the model, thumbnails and times.
    #[cfg(test)]
    pub(crate) fn counts(&self) -> [usize; 3] {
        [self.pictures.len(), self.thumbnails.len(), self.times.len()]
    }

    /// Drops results that are not wanted, if they are old, or of deleted nodes or another model.
    pub(super) fn evict(
        &mut self,
        document: &OpenDocument,
        wanted: &WantedResults,
        model_revision: u64,
    ) -> DroppedResults {
        let mut numbers: Vec<u64> = self.pictures.values().map(|picture| picture.number).collect();
        numbers.sort_unstable();
        let oldest = numbers.len().saturating_sub(KEPT_PICTURES + wanted.subjects.len());
        let oldest = numbers.get(oldest).copied();
        let is_kept = |subject: &ViewSubject, picture: &ResultPicture| {
            let exists = match subject {
                ViewSubject::Outputs => true,
                ViewSubject::Node(node) => node_paths::exists(document, &node.node),
            };
            exists
                && oldest.is_none_or(|oldest| picture.number >= oldest)
                && picture.model.model_revision == model_revision
        };
        let subjects = self.pictures.iter();
        let subjects =
            subjects.filter(|(subject, picture)| !wanted.subjects.contains(subject) && !is_kept(subject, picture));
        let subjects = subjects.map(|(subject, _)| subject.clone()).collect();
        let nodes = self.thumbnails.keys();
        let nodes = nodes.filter(|node| !wanted.thumbnails.contains(node) && !node_paths::exists(document, &node.node));
        let thumbnails = nodes.cloned().collect();
        self.times.retain(|node, _| node_paths::exists(document, node));
        self.drop_results(DroppedResults { subjects, thumbnails })
    }

    /// Drops all results of nodes.
    pub(super) fn drop_nodes(&mut self) -> DroppedResults {
        let subjects = self.pictures.keys();
        let subjects = subjects.filter(|subject| **subject != ViewSubject::Outputs);
        let dropped = DroppedResults {
            subjects: subjects.cloned().collect(),
            thumbnails: self.thumbnails.keys().cloned().collect(),
        };
        self.times.clear();
        self.drop_results(dropped)
    }

    fn drop_results(&mut self, dropped: DroppedResults) -> DroppedResults {
        for subject in &dropped.subjects {
            self.pictures.remove(subject);
        }
        for node in &dropped.thumbnails {
            self.thumbnails.remove(node);
        }
        dropped
    }
}

#[cfg(test)]
mod tests {
    use sabi_engine::evaluating::TextureSet;
    use sabi_export::SetKey;
    use sabi_graph::PortType;

    use super::*;

    fn values_of(size: u32) -> Arc<InspectedResult> {
        Arc::new(InspectedResult {
            ty: PortType::Mask,
            size,
            set: TextureSet {
                key: SetKey {
                    material: 0,
                    uv_tile: [0, 0],
                    udim: None,
                },
                name: String::new(),
            },
            planes: Vec::new(),
            is_on_surface: Vec::new(),
        })
    }

    fn wanted(inspected: &str, measured: Option<&str>) -> WantedResults {
        let result = |node: &str| NodeRef {
            node: node.to_owned(),
            port: None,
        };
        WantedResults {
            inspected: Some(result(inspected)),
            measured: measured.map(result),
            ..WantedResults::default()
        }
    }

    /// The engine sends values once, and may do so after another result was requested.
    #[test]
    fn values_that_arrive_late_neither_replace_those_that_are_wanted_nor_are_they_lost() {
        let mut results = EvaluationResults::default();
        let shown = |results: &EvaluationResults| {
            results
                .inspected
                .as_ref()
                .map(|(node, values)| (node.node.clone(), values.size))
        };
        let node = |node: &str| wanted(node, None).inspected.expect("a result");
        let levels = wanted("levels", Some("noise"));
        results.share_values(&levels);
        results.take_values(Some(&levels), node("noise"), values_of(1));
        results.take_values(Some(&levels), node("levels"), values_of(2));
        assert_eq!(shown(&results), Some(("levels".to_owned(), 2)));
        let noise = wanted("noise", None);
        results.share_values(&noise);
        assert_eq!(shown(&results), Some(("noise".to_owned(), 1)), "it was measured before");
        let is_shown = results.take_values(Some(&noise), node("levels"), values_of(3));
        assert!(!is_shown);
        assert_eq!(shown(&results), Some(("noise".to_owned(), 1)));
        results.share_values(&levels);
        assert_eq!(shown(&results), Some(("levels".to_owned(), 3)));
    }
}
