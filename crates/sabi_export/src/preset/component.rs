//! Components as preset files write them: `roughness`, `1 - roughness`, `base_color.r`, `output(wear)`.

use std::fmt;

use super::{Component, ComponentSource, OutputPart};
use crate::{Channel, MeshMap};

/// Letters of components, by their index.
const LETTERS: [[char; 3]; 2] = [['r', 'g', 'b'], ['x', 'y', 'z']];

/// Reads the components of a key that takes `count`: one channel of so many components, or one component.
pub(super) fn components(text: &str, count: usize) -> Result<Vec<Component>, String> {
    let (is_inverted, rest) = match text.split_once('-') {
        Some((one, rest)) if one.trim() == "1" => (true, rest.trim()),
        _ => (false, text.trim()),
    };
    let (name, index) = match rest.rsplit_once('.') {
        Some((name, letter)) if !rest.ends_with(')') => (name, Some(letter_index(letter, text)?)),
        _ => (rest, None),
    };
    let channel = channel(name)?;
    if let Some(name) = channel.output_name() {
        let part = |at| match index {
            Some(index) => OutputPart::Single(index),
            None => OutputPart::Whole { at, of: count },
        };
        let component = |at| Component {
            source: ComponentSource::Output(name.to_owned(), part(at)),
            is_inverted,
        };
        return Ok((0..count).map(component).collect());
    }
    let has = channel.components();
    if let Some(index) = index.filter(|index| *index >= has) {
        let letter = LETTERS[0][index];
        return Err(format!(
            "`{text}`: {name} has one component and no `.{letter}`; leave that out"
        ));
    }
    let indices: Vec<usize> = match (index, has) {
        (Some(index), _) => vec![index; count],
        (None, 1) => vec![0; count],
        (None, has) if has == count => (0..has).collect(),
        (None, has) => {
            return Err(format!(
                "`{text}`: {name} has {has} components and one is needed here; write `{name}.r`, `{name}.g` or `{name}.b`"
            ));
        }
    };
    let component = |index| Component {
        source: ComponentSource::Channel(channel.clone(), index),
        is_inverted,
    };
    Ok(indices.into_iter().map(component).collect())
}

fn letter_index(letter: &str, text: &str) -> Result<usize, String> {
    let of = |letters: &[char; 3]| letters.iter().position(|known| letter.chars().eq([*known]));
    let found = LETTERS.iter().find_map(of);
    found.ok_or_else(|| format!("`{text}`: there is no component `.{letter}`; there is: .r, .g, .b (or .x, .y, .z)"))
}

/// The channel of a name.
pub(super) fn channel(name: &str) -> Result<Channel, String> {
    let output = name.strip_prefix("output(").and_then(|rest| rest.strip_suffix(')'));
    if let Some(output) = output {
        return match output.trim() {
            "" => Err("`output()` names no output; write the name of an output node in it".to_owned()),
            // The graph decides what it is.
            output => Ok(Channel::Mask(output.to_owned())),
        };
    }
    if let Some(map) = name.strip_prefix("mesh(").and_then(|rest| rest.strip_suffix(')')) {
        return MeshMap::of_name(map.trim()).map(Channel::Mesh);
    }
    let found = Channel::ALL.into_iter().find(|channel| channel.name() == name);
    found.ok_or_else(|| {
        let known: Vec<String> = Channel::ALL.iter().map(|channel| channel.name().into_owned()).collect();
        format!(
            "there is no channel `{name}`; there is: {}, output(NAME), mesh(NAME)",
            known.join(", ")
        )
    })
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_inverted {
            f.write_str("1 - ")?;
        }
        match &self.source {
            ComponentSource::Constant(value) => write!(f, "{value}"),
            ComponentSource::Output(name, OutputPart::Whole { .. }) => write!(f, "output({name})"),
            ComponentSource::Output(name, OutputPart::Single(index)) => write!(f, "output({name}).{}", letter(*index)),
            ComponentSource::Channel(channel, index) => {
                match channel {
                    Channel::Mask(name) | Channel::Color(name) | Channel::Vector(name) => write!(f, "output({name})")?,
                    Channel::Mesh(map) => write!(f, "mesh({})", map.name())?,
                    channel => f.write_str(&channel.name())?,
                }
                match channel.components() {
                    1 => Ok(()),
                    _ => write!(f, ".{}", letter(*index)),
                }
            }
        }
    }
}

/// Letter of a component; channels have at most three.
fn letter(index: usize) -> char {
    LETTERS[0].get(index).copied().unwrap_or('?')
}
