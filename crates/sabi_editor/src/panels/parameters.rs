//! Parameters of the selected nodes; with nothing selected, the exposed parameters of the shown graph.

use egui::{Label, RichText, ScrollArea, Ui};
use sabi_editing::connections::PendingWire;
use sabi_editing::painting::{PAINT, STROKES};
use sabi_editing::{OpenDocument, connections, exposed_knobs, node_paths, ports as document_ports};
use sabi_engine::catalog::{Interface, Knob};
use sabi_graph::{NodeId, OutputRef, SlotRef, Value};

use super::input_histogram::InputHistogram;
use super::instance::InstanceState;
use super::painting::PaintingPanel;
use super::{channel_sections, exposed_parameters, instance, ports, variants};
use crate::action::Action;
use crate::context::{View, ViewContext};
use crate::knobs::{KnobMemory, KnobRow, ParamMask, knobs_ui};

/// Panel of parameters.
#[derive(Default)]
pub(crate) struct Parameters {
    memory: KnobMemory,
    exposed: exposed_parameters::ExposedParameters,
    variants: variants::Variants,
    instance: InstanceState,
    painting: PaintingPanel,
    histogram: InputHistogram,
}

impl View for Parameters {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let document = context.document;
        if context.is_use_view || document.selection().is_empty() {
            return self.of_graph(ui, context);
        }
        if let Some(id) = alike(document) {
            return self.of_node(ui, context, &id);
        }
        let count = document.selection().len();
        let sentence =
            format!("{count} nodes of several kinds are selected; select nodes of one kind to change them together.");
        ui.add(Label::new(RichText::new(sentence).color(context.theme.quiet)).wrap());
        // Called without rows, so that a drag whose row has disappeared ends.
        let events = knobs_ui(ui, context.theme, &mut self.memory, &[], &context.lengths());
        drop(events);
        Vec::new()
    }
}

impl Parameters {
    /// Exposed parameters, variants, inputs and outputs of the shown graph.
    fn of_graph(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let area = ScrollArea::vertical().id_salt("graph").auto_shrink(false);
        area.show(ui, |ui| {
            actions.extend(self.exposed.show(ui, context, &mut self.memory));
            actions.extend(self.variants.show(ui, context));
            if !context.is_use_view {
                let commands = ports::show(ui, context.theme, context.document);
                actions.extend(commands.into_iter().map(Action::edit));
            }
        });
        actions
    }

    /// Parameters of a node, or of several of its kind.
    fn of_node(&mut self, ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId) -> Vec<Action> {
        let Parameters {
            memory,
            instance,
            painting,
            histogram,
            ..
        } = self;
        let (document, theme) = (context.document, context.theme);
        let (Some(interface), Some(node)) = (document.interface(id), document.node(id)) else {
            return Vec::new();
        };
        let count = document.selection().len();
        heading(ui, context, id, interface);
        let randomized = instance::random_values(ui, context, id, interface, instance);
        let mut actions: Vec<Action> = randomized.into_iter().collect();
        actions.extend(painting.show(ui, context, id));
        ui.separator();
        let links: Vec<KnobLinks<'_>> = interface
            .knobs
            .iter()
            .map(|knob| KnobLinks::of(document, id, knob))
            .collect();
        let rows: Vec<KnobRow<'_>> = interface
            .knobs
            .iter()
            .zip(&links)
            // Versions of strokes are for files; the list of strokes shows their contents.
            .filter(|(knob, _)| node.kind != PAINT || knob.name != STROKES)
            .map(|(knob, links)| KnobRow {
                knob,
                value: node.params.get(&knob.name),
                wired: links.wired.as_deref(),
                mask: match &links.mask {
                    Some(mask) => ParamMask::Of(mask),
                    None if count == 1 && interface.param_mask(&knob.name).is_some() => ParamMask::Unlinked,
                    None => ParamMask::NotTaken,
                },
                exposed: links.exposed,
                differs: differs(document, &knob.name, node.params.get(&knob.name)),
            })
            .collect();
        let switches = channel_sections::switches(&interface.knobs);
        // Each node opens at its top.
        let area = ScrollArea::vertical().id_salt(id).auto_shrink(false);
        let shown = area.show(ui, |ui| {
            let of_histogram = histogram.show(ui, context, id);
            let of_knobs = ui.push_id(id, |ui| {
                let sections = channel_sections::sections(&rows, &switches);
                let events = knobs_ui(ui, theme, memory, &sections, &context.lengths());
                let actions = of_histogram.into_iter().chain(events).map(|event| Action::Knob {
                    node: id.clone(),
                    event,
                });
                actions.collect::<Vec<Action>>()
            });
            let of_instance = instance::show(ui, context, id, interface, instance);
            of_knobs.inner.into_iter().chain(of_instance).collect::<Vec<Action>>()
        });
        actions.extend(shown.inner);
        actions
    }
}

#[cfg(test)]
impl Parameters {
    /// Returns whether the histogram of an input is drawn.
    pub(crate) fn has_histogram(&self) -> bool {
        self.histogram.is_shown()
    }

    /// Place of a value in that histogram, if it is drawn in this rectangle.
    pub(crate) fn place_in_histogram(&self, value: f32, rect: egui::Rect) -> Option<f32> {
        self.histogram.place_of(value, rect)
    }
}

/// One of the selected nodes, if they are all of the same kind.
fn alike(document: &OpenDocument) -> Option<NodeId> {
    let kind = |id: &NodeId| document.node(id).map(|node| (&node.kind, &node.group));
    let mut selected = document.selection().iter();
    let first = selected.next()?;
    selected.all(|other| kind(other) == kind(first)).then(|| first.clone())
}

/// Title, summary and fault of the selected node.
fn heading(ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId, interface: &Interface) {
    let document = context.document;
    ui.heading(match document.selection().len() {
        1 => document.title(id),
        count => format!("{count} × {}", interface.label),
    });
    ui.colored_label(context.theme.quiet, &interface.summary);
    if let Some(fault) = context.evaluation.faults.of(&node_paths::full_id(document, id)) {
        ui.colored_label(context.theme.fault, context.said(fault));
    }
}

/// Links of a parameter, by their names.
struct KnobLinks<'d> {
    /// Title of the node that gives it its value.
    wired: Option<String>,
    /// Mask that multiplies it.
    mask: Option<String>,
    /// Name under which it is exposed.
    exposed: Option<&'d str>,
}

impl<'d> KnobLinks<'d> {
    fn of(document: &'d OpenDocument, id: &NodeId, knob: &Knob) -> KnobLinks<'d> {
        let wire = feeder(document, id, knob);
        KnobLinks {
            wired: wire.map(|from| document.title(&from.node)),
            mask: mask_of(document, id, &knob.name),
            exposed: exposed_knobs::exposed_as(document, id, &knob.name),
        }
    }
}

/// Wire that gives a parameter its value. A parameter of a source may have the name of an input without being its value.
fn feeder<'d>(document: &'d OpenDocument, id: &NodeId, knob: &Knob) -> Option<&'d OutputRef> {
    let is_fed = knob.is_of_input || document.node(id)?.group.is_some();
    let wire = document.graph().link_into(id.as_str(), &knob.name);
    wire.filter(|_| is_fed)
}

/// Name of the mask that multiplies a parameter: the title of its node, or the input of the group that it comes from.
pub(crate) fn mask_of(document: &OpenDocument, id: &NodeId, knob: &str) -> Option<String> {
    document.interface(id)?.param_mask(knob)?;
    let slot = SlotRef {
        node: id.clone(),
        name: knob.to_owned(),
    };
    let fed = document_ports::exposed_as(document, &PendingWire::Into(slot.clone()));
    let fed = fed.map(|input| format!("the input '{}'", document_ports::input_label(document, input)));
    fed.or_else(|| Some(document.title(&connections::wire_into(document, &slot)?.node)))
}

/// Returns whether a selected node has another value. All selected nodes are of the same kind.
fn differs(document: &OpenDocument, knob: &str, value: Option<&Value>) -> bool {
    let mut selected = document.selection().iter().filter_map(|other| document.node(other));
    selected.any(|other| other.params.get(knob) != value)
}
