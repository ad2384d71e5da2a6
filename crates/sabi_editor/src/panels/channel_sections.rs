//! Sections of a node's parameters: a toggle `X_on` begins a section of `X` and of all parameters whose names begin with `X_`,
//! as the channels of a layer do. While the toggle is off, the rows below it are hidden.

use sabi_engine::catalog::Knob;
use sabi_nodes::kind::Role;

use crate::knobs::{KnobRow, KnobSection};

/// Ending of the name of a toggle that begins a section.
const SWITCH: &str = "_on";

/// Toggles that begin sections: the stem of each section, and the toggle with the label of the section.
pub(super) fn switches(knobs: &[Knob]) -> Vec<(String, Knob)> {
    let switch = |knob: &Knob| {
        let stem = knob
            .name
            .strip_suffix(SWITCH)
            .filter(|_| knob.ty.role == Role::Toggle)?;
        // In capitals, as other titles of sections, and unlike the parameter of the same name.
        let label = knobs.iter().find(|known| known.name == stem)?.label.to_uppercase();
        let relabeled = Knob { label, ..knob.clone() };
        Some((stem.to_owned(), relabeled))
    };
    knobs.iter().filter_map(switch).collect()
}

/// Sorts rows into sections: first those that belong to none, then one section for each switch.
pub(super) fn sections<'r>(rows: &[KnobRow<'r>], switches: &'r [(String, Knob)]) -> Vec<KnobSection<'r>> {
    let stem_of = |name: &str| {
        let mut stems = switches.iter().map(|(stem, _)| stem.as_str());
        stems.find(|stem| {
            name.strip_prefix(stem)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
        })
    };
    let of = |stem: Option<&str>| -> Vec<KnobRow<'r>> {
        let rows = rows.iter().filter(|row| stem_of(&row.knob.name) == stem);
        rows.copied().collect()
    };
    let general = KnobSection {
        title: None,
        switch: None,
        rows: of(None),
    };
    let channels = switches.iter().map(|(stem, switch)| {
        let name = &switch.name;
        let (own, rows): (Vec<KnobRow<'r>>, Vec<KnobRow<'r>>) =
            of(Some(stem)).into_iter().partition(|row| row.knob.name == *name);
        KnobSection {
            title: None,
            switch: own.first().map(|row| KnobRow { knob: switch, ..*row }),
            rows,
        }
    });
    std::iter::once(general).chain(channels).collect()
}

#[cfg(test)]
mod tests {
    use sabi_engine::Kinds;
    use sabi_engine::catalog::Catalog;

    use super::*;
    use crate::knobs::ParamMask;

    #[test]
    fn a_layer_has_a_section_for_each_channel_and_other_nodes_have_none() {
        let catalog = Catalog::new(&Kinds::builtin());
        let named = |kind: &str| -> Vec<Vec<String>> {
            let entry = catalog.entry(kind).expect("a kind");
            let row = |knob| KnobRow {
                knob,
                value: None,
                wired: None,
                mask: ParamMask::NotTaken,
                exposed: None,
                differs: false,
            };
            let rows: Vec<KnobRow<'_>> = entry.knobs.iter().map(row).collect();
            let switches = switches(&entry.knobs);
            let sections = sections(&rows, &switches);
            let text = |section: &KnobSection<'_>| {
                let switch = section.switch.iter().map(|row| format!("[{}]", row.knob.label));
                let rows = section.rows.iter().map(|row| row.knob.name.clone());
                switch.chain(rows).collect()
            };
            sections.iter().map(text).collect()
        };
        let layer = named("effect/layer");
        assert_eq!(
            layer[0],
            [
                "finish_mode",
                "slope_mode",
                "slope_strength",
                "opacity",
                "mask",
                "slope"
            ]
        );
        assert_eq!(layer[1], ["[COLOR]", "color", "color_mode", "color_map"]);
        assert_eq!(layer[4], ["[HEIGHT]", "height", "height_mode", "height_map"]);
        assert_eq!(
            layer[5],
            ["[OCCLUSION]", "occlusion", "occlusion_mode", "occlusion_map"]
        );
        let emission = ["[EMISSION]", "emission", "emission_mode", "emission_strength"];
        assert_eq!(layer[7], emission);
        assert_eq!(layer[8], ["[CLEAR COAT]", "coat", "coat_roughness", "coat_map"]);
        assert_eq!(layer[9], ["[ANISOTROPY]", "anisotropy", "anisotropy_direction"]);
        assert_eq!(layer[10], ["[SHEEN]", "sheen", "sheen_roughness"]);
        assert_eq!(layer[11], ["[SUBSURFACE]", "subsurface", "subsurface_transmission"]);
        assert_eq!(layer.len(), 12);
        assert_eq!(named("noise/simplex").len(), 1);
    }
}
