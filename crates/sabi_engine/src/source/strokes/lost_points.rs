//! Strokes with lost points, for the warning of a paint node.

use std::collections::BTreeMap;

use sabi_paint::{Stroke, Version};

use super::Strokes;

/// Maximum number of strokes that a warning names.
const NAMED_STROKES: usize = 4;

impl Strokes {
    /// Lists the strokes of a version that have lost points, with the number of points, as text: `'label': 3, stroke 2 of
    /// 12: 1 and 5 more`.
    pub(crate) fn lost_places(&self, version: Version, lost: &BTreeMap<Version, usize>) -> String {
        let list = self.lock().book.list(version);
        let Some(list) = list else { return String::new() };
        let strokes = list.strokes.iter().enumerate();
        let lost: Vec<String> = strokes
            .filter_map(|(index, stroke)| {
                let lost = lost.get(&stroke.id)?;
                Some(format!("{}: {lost}", title(stroke, index, list.strokes.len())))
            })
            .collect();
        some_of(&lost)
    }
}

/// Returns the name of a stroke for sentences, or its number from below.
pub(crate) fn title(stroke: &Stroke, index: usize, count: usize) -> String {
    if stroke.name.is_empty() {
        format!("stroke {} of {count}", index + 1)
    } else {
        format!("'{}'", stroke.name)
    }
}

/// Joins the first few of some texts, and counts the others.
fn some_of(all: &[String]) -> String {
    let named = &all[..all.len().min(NAMED_STROKES)];
    let more = all.len() - named.len();
    let named = named.join(", ");
    if more == 0 {
        named
    } else {
        format!("{named} and {more} more")
    }
}

#[cfg(test)]
mod tests {
    use sabi_paint::{Brush, Stroke};

    use super::{some_of, title};

    #[test]
    fn a_stroke_is_told_by_its_name_or_its_number() {
        let mut stroke = Stroke::new(Brush::default(), Vec::new());
        assert_eq!(title(&stroke, 2, 12), "stroke 3 of 12");
        "label".clone_into(&mut stroke.name);
        assert_eq!(title(&stroke, 2, 12), "'label'");
    }

    #[test]
    fn a_handful_of_strokes_is_named_and_the_others_are_counted() {
        let words = |count: usize| (0..count).map(|index| format!("s{index}: 1")).collect::<Vec<String>>();
        assert_eq!(some_of(&words(2)), "s0: 1, s1: 1");
        assert_eq!(some_of(&words(9)), "s0: 1, s1: 1, s2: 1, s3: 1 and 5 more");
    }
}
