//! Outputs of the graph in presets: the graph decides how many components each has.

use super::{Component, ComponentSource, Map, MapContent, OutputPart, Preset, PresetError, When};
use crate::{Channel, OutputKind};

impl Preset {
    /// Replaces names of outputs by the outputs of a graph. An output that the graph does not have is a mask of 0.
    ///
    /// # Errors
    /// A component of an output that it does not have, or a color or vector in the place of one component.
    pub fn for_outputs(mut self, outputs: &[Channel]) -> Result<Preset, PresetError> {
        for map in &mut self.maps {
            let replaced = replace(map, outputs);
            replaced.map_err(|why| PresetError {
                file: self.name.clone(),
                why: format!("map `{}`: {why}", map.name),
            })?;
        }
        Ok(self)
    }
}

fn replace(map: &mut Map, outputs: &[Channel]) -> Result<(), String> {
    let named = |name: &str| {
        let found = outputs.iter().find(|output| output.output_name() == Some(name));
        found
            .cloned()
            .unwrap_or_else(|| Channel::output(OutputKind::Mask, name.to_owned()))
    };
    if let When::Connected(channel) | When::AboveOne(channel) = &mut map.when
        && let Some(name) = channel.output_name()
    {
        *channel = named(name);
    }
    let MapContent::Packed(components) = &mut map.content else {
        return Ok(());
    };
    for component in components {
        if let ComponentSource::Output(name, part) = &component.source {
            let channel = named(name);
            let index = index_of(component, *part, channel.components())?;
            component.source = ComponentSource::Channel(channel, index);
        }
    }
    Ok(())
}

/// Index of the component of an output that has so many.
fn index_of(component: &Component, part: OutputPart, has: usize) -> Result<usize, String> {
    match part {
        OutputPart::Single(0) if has == 1 => Ok(0),
        OutputPart::Single(_) if has == 1 => Err(format!(
            "`{component}`: this output is a mask, which has one component; leave the letter out"
        )),
        OutputPart::Single(index) => Ok(index),
        OutputPart::Whole { .. } if has == 1 => Ok(0),
        OutputPart::Whole { at, of } if has == of => Ok(at),
        OutputPart::Whole { .. } => Err(format!(
            "`{component}`: this output has {has} components and one is needed here; write `.r`, `.g` or `.b` behind it"
        )),
    }
}
