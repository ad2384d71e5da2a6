//! Names of the files of a texture set.

use crate::names::file_stem;
use crate::{Channel, ExportError};

/// Pattern of file names without their endings: text with the placeholders `{material}` and `{channel}`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamePattern {
    segments: Vec<Segment>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Segment {
    Text(String),
    Material,
    Channel,
}

impl Default for NamePattern {
    fn default() -> Self {
        NamePattern {
            segments: vec![Segment::Material, Segment::Text("_".to_owned()), Segment::Channel],
        }
    }
}

impl NamePattern {
    /// Pattern that is used where none is given.
    pub const DEFAULT: &str = "{material}_{channel}";

    /// Parses a pattern. `words` are further placeholders and their values, which are converted to file names.
    ///
    /// # Errors
    /// It has no `{channel}`, an unknown placeholder, or letters that no file name may have.
    pub fn parse(text: &str, words: &[(&str, &str)]) -> Result<NamePattern, ExportError> {
        let fault = |why: String| ExportError::Names {
            pattern: text.to_owned(),
            why,
        };
        let mut segments = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            push_text(&mut segments, before);
            let (word, after) = after
                .split_once('}')
                .ok_or_else(|| fault("a brace is opened and not closed; close it after the word".to_owned()))?;
            match (word, words.iter().find(|(known, _)| *known == word)) {
                ("material", _) => segments.push(Segment::Material),
                ("channel", _) => segments.push(Segment::Channel),
                (_, Some((_, stands_for))) => push_text(&mut segments, &file_stem(stands_for)),
                (_, None) => {
                    let known = words.iter().map(|(known, _)| format!(", {{{known}}}"));
                    let known: String = known.collect();
                    return Err(fault(format!(
                        "nobody knows {{{word}}}; there is: {{material}}, {{channel}}{known}"
                    )));
                }
            }
            rest = after;
        }
        push_text(&mut segments, rest);
        let pattern = NamePattern { segments };
        if !pattern.segments.contains(&Segment::Channel) {
            let why = "without {channel} all maps would be one file; write it where the channel's name is to stand";
            return Err(fault(why.to_owned()));
        }
        let sample = pattern.stem("material", &Channel::BaseColor);
        if file_stem(&sample) != sample {
            let why =
                "it has letters that a file name cannot have, or too many; use plain letters, digits, '_' and '-'";
            return Err(fault(why.to_owned()));
        }
        Ok(pattern)
    }

    /// The name of a map without its ending.
    pub fn stem(&self, material: &str, channel: &Channel) -> String {
        let segments = self.segments.iter().map(|segment| match segment {
            Segment::Text(text) => text.clone(),
            Segment::Material => material.to_owned(),
            Segment::Channel => channel.name().into_owned(),
        });
        segments.collect()
    }

    /// Returns true if this pattern gives a map of the channel this stem for some name of a material.
    pub fn may_give(&self, stem: &str, channel: &Channel) -> bool {
        let is_material = |segment: &Segment| *segment == Segment::Material;
        let text = |segments: &[Segment]| {
            let segments = segments.to_vec();
            NamePattern { segments }.stem("", channel)
        };
        let Some(first) = self.segments.iter().position(is_material) else {
            return stem == text(&self.segments);
        };
        // The first one exists, so a last one does.
        let last = self.segments.iter().rposition(is_material).unwrap_or(first);
        let [before, after] = [text(&self.segments[..first]), text(&self.segments[last + 1..])];
        let middle = stem.strip_prefix(&before).and_then(|rest| rest.strip_suffix(&after));
        middle.is_some_and(|middle| !middle.is_empty())
    }
}

fn push_text(segments: &mut Vec<Segment>, text: &str) {
    if !text.is_empty() {
        segments.push(Segment::Text(text.to_owned()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_where_the_pattern_has_them() {
        let words = [("graph", "worn/bench"), ("size", "1024")];
        let cases = [
            (NamePattern::DEFAULT, "wood_base_color"),
            ("T_{material}_{channel}_{size}", "T_wood_base_color_1024"),
            ("{graph}-{channel}", "worn_bench-base_color"),
            ("{channel}", "base_color"),
        ];
        for (pattern, stem) in cases {
            let pattern = NamePattern::parse(pattern, &words).unwrap();
            assert_eq!(pattern.stem("wood", &Channel::BaseColor), stem);
            assert!(pattern.may_give(stem, &Channel::BaseColor), "{stem}");
            assert!(!pattern.may_give(stem, &Channel::Height), "{stem}");
        }
        assert_eq!(
            NamePattern::parse(NamePattern::DEFAULT, &[]).unwrap(),
            NamePattern::default()
        );
        assert!(!NamePattern::default().may_give("_height", &Channel::Height));
    }

    #[test]
    fn patterns_that_cannot_be_names_say_why() {
        let cases = [
            (
                "map",
                "without {channel} all maps would be one file; write it where the channel's name is to stand",
            ),
            ("{channel", "a brace is opened and not closed; close it after the word"),
            (
                "{chanel}",
                "nobody knows {chanel}; there is: {material}, {channel}, {size}",
            ),
            (
                "../{channel}",
                "it has letters that a file name cannot have, or too many; use plain letters, digits, '_' and '-'",
            ),
            (
                ".{channel}",
                "it has letters that a file name cannot have, or too many; use plain letters, digits, '_' and '-'",
            ),
        ];
        for (pattern, why) in cases {
            let told = NamePattern::parse(pattern, &[("size", "512")]).unwrap_err();
            let told = told.to_string();
            assert_eq!(told, format!("maps cannot be named '{pattern}': {why}"));
        }
        assert!(NamePattern::parse(&format!("{}{{channel}}", "a".repeat(300)), &[]).is_err());
    }
}
