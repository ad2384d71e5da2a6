//! The order of strokes in their list, and their groups.

use std::collections::BTreeSet;
use std::sync::Arc;

use sabi_paint::{Step, Stroke, StrokeGroup, StrokeList, Version};

/// A row of the list, the topmost first.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum StrokeRow {
    /// Title of a group whose strokes follow, if it is open: indices of the lowest and the topmost of them.
    Group {
        group: Arc<StrokeGroup>,
        lowest: usize,
        top: usize,
    },
    /// A stroke by its index, the lowest 0.
    Stroke(usize),
}

impl StrokeRow {
    /// Index of the topmost stroke of the row.
    fn top(&self) -> usize {
        match self {
            StrokeRow::Group { top, .. } => *top,
            StrokeRow::Stroke(index) => *index,
        }
    }
}

/// Rows of a list, without the strokes of groups that are closed. A group whose strokes are apart has a title for each
/// part.
pub(super) fn rows_of(list: &StrokeList, closed: &BTreeSet<u32>) -> Vec<StrokeRow> {
    let number = |stroke: &Stroke| stroke.group.as_ref().map(|group| group.number);
    let mut rows = Vec::new();
    let mut top = list.strokes.len();
    let runs: Vec<&[Arc<Stroke>]> = list.strokes.chunk_by(|a, b| number(a) == number(b)).collect();
    for run in runs.into_iter().rev() {
        let lowest = top - run.len();
        let mut is_open = true;
        if let Some(group) = run.first().and_then(|stroke| stroke.group.clone()) {
            is_open = !closed.contains(&group.number);
            let top = top - 1;
            rows.push(StrokeRow::Group { group, lowest, top });
        }
        if is_open {
            rows.extend((lowest..top).rev().map(StrokeRow::Stroke));
        }
        top = lowest;
    }
    rows
}

/// Number of strokes below the gap before a row.
pub(super) fn below_gap(rows: &[StrokeRow], gap: usize) -> usize {
    rows.get(gap).map_or(0, |row| row.top() + 1)
}

/// Steps that move strokes to the gap in the list that has `below_gap` strokes below it. They keep their order.
pub(super) fn moved(list: &StrokeList, strokes: &BTreeSet<Version>, below_gap: usize) -> Vec<Step> {
    let all: Vec<Version> = list.strokes.iter().map(|stroke| stroke.id).collect();
    let is_moved = |id: &&Version| strokes.contains(id);
    let stays = |id: &&Version| !strokes.contains(id);
    let mut wanted: Vec<Version> = all[..below_gap.min(all.len())].iter().filter(stays).copied().collect();
    let first = wanted.len();
    wanted.extend(all.iter().filter(is_moved));
    let end = wanted.len();
    wanted.extend(all[below_gap.min(all.len())..].iter().filter(stays));
    if wanted == all {
        return Vec::new();
    }
    let mut now = all;
    let mut steps = Vec::new();
    for index in first..end {
        let stroke = wanted[index];
        now.retain(|id| *id != stroke);
        let before = index.checked_sub(1).map(|before| wanted[before]);
        let to = before
            .and_then(|before| now.iter().position(|id| *id == before))
            .map_or(0, |at| at + 1);
        now.insert(to, stroke);
        steps.push(Step::Move { stroke, to });
    }
    steps
}

/// Steps that put strokes into a group at the place of the topmost one: into the only group that some of them are in,
/// or into a new one.
pub(super) fn grouped(list: &StrokeList, strokes: &BTreeSet<Version>) -> Vec<Step> {
    let top = list.strokes.iter().rposition(|stroke| strokes.contains(&stroke.id));
    let mut steps = moved(list, strokes, top.map_or(0, |top| top + 1));
    let marked = list.strokes.iter().filter(|stroke| strokes.contains(&stroke.id));
    let mut known: Vec<&Arc<StrokeGroup>> = marked.filter_map(|stroke| stroke.group.as_ref()).collect();
    known.dedup_by_key(|group| group.number);
    let group = match known.as_slice() {
        [only] => Arc::clone(only),
        _ => {
            let number = list.free_group_number();
            Arc::new(StrokeGroup {
                number,
                name: format!("Group {number}"),
                opacity: 1.0,
                is_hidden: false,
            })
        }
    };
    steps.push(Step::Group {
        strokes: strokes.iter().copied().collect(),
        group: Some(group),
    });
    steps
}

/// The strokes of a group.
pub(super) fn members(list: &StrokeList, number: u32) -> BTreeSet<Version> {
    let is_member = |stroke: &&Arc<Stroke>| stroke.group.as_ref().is_some_and(|group| group.number == number);
    list.strokes.iter().filter(is_member).map(|stroke| stroke.id).collect()
}

/// The group whose strokes are exactly these.
pub(super) fn group_of(list: &StrokeList, strokes: &BTreeSet<Version>) -> Option<Arc<StrokeGroup>> {
    let first = list.strokes.iter().find(|stroke| strokes.contains(&stroke.id))?;
    let group = first.group.clone()?;
    (members(list, group.number) == *strokes).then_some(group)
}

/// The step that changes a group.
pub(super) fn changed(list: &StrokeList, group: StrokeGroup) -> Step {
    Step::Group {
        strokes: members(list, group.number).into_iter().collect(),
        group: Some(Arc::new(group)),
    }
}

#[cfg(test)]
mod tests {
    use sabi_paint::{Brush, StrokeBook};

    use super::*;

    /// A list of strokes that are named by letters, with the book of its steps.
    fn list_of(names: &str) -> (StrokeBook, Version) {
        let mut book = StrokeBook::default();
        let mut version = Version::EMPTY;
        for name in names.chars() {
            let stroke = Stroke {
                name: name.to_string(),
                ..Stroke::new(Brush::default(), Vec::new())
            };
            version = book.push(version, &Step::Add(Arc::new(stroke)));
        }
        (book, version)
    }

    fn names(list: &StrokeList) -> String {
        list.strokes.iter().map(|stroke| stroke.name.as_str()).collect()
    }

    fn ids(list: &StrokeList, names: &str) -> BTreeSet<Version> {
        let named = list.strokes.iter().filter(|stroke| names.contains(&stroke.name));
        named.map(|stroke| stroke.id).collect()
    }

    fn after(book: &mut StrokeBook, mut version: Version, steps: &[Step]) -> (Version, Arc<StrokeList>) {
        for step in steps {
            version = book.push(version, step);
        }
        (version, book.list(version).unwrap())
    }

    #[test]
    fn strokes_are_moved_together_to_any_gap_in_their_order() {
        for (moved_names, gap, expected) in [
            ("bd", 0, "bdace"),
            ("bd", 5, "acebd"),
            ("bd", 3, "acbde"),
            ("e", 1, "aebcd"),
            ("a", 1, "abcde"),
            ("abcde", 2, "abcde"),
        ] {
            let (mut book, version) = list_of("abcde");
            let list = book.list(version).unwrap();
            let steps = moved(&list, &ids(&list, moved_names), gap);
            let (_, list) = after(&mut book, version, &steps);
            assert_eq!(names(&list), expected, "{moved_names} to {gap}");
        }
    }

    #[test]
    fn a_group_gathers_its_strokes_and_shows_them_below_its_title_while_it_is_open() {
        let (mut book, version) = list_of("abcde");
        let list = book.list(version).unwrap();
        let chosen = ids(&list, "bd");
        let (version, list) = after(&mut book, version, &grouped(&list, &chosen));
        assert_eq!(names(&list), "acbde");
        let rows = rows_of(&list, &BTreeSet::new());
        let shown: Vec<String> = rows
            .iter()
            .map(|row| match row {
                StrokeRow::Group { group, lowest, top } => format!("{} {lowest}-{top}", group.name),
                StrokeRow::Stroke(index) => list.strokes[*index].name.clone(),
            })
            .collect();
        assert_eq!(shown, ["e", "Group 1 2-3", "d", "b", "c", "a"]);
        assert_eq!(rows_of(&list, &BTreeSet::from([1])).len(), 4);
        assert_eq!([0, 1, 2, 6].map(|gap| below_gap(&rows, gap)), [5, 4, 4, 0]);
        assert_eq!(group_of(&list, &chosen).map(|group| group.number), Some(1));
        assert_eq!(list.free_group_number(), 2);
        let hidden = StrokeGroup {
            is_hidden: true,
            ..(*group_of(&list, &chosen).unwrap()).clone()
        };
        let (_, list) = after(&mut book, version, &[changed(&list, hidden)]);
        let gone: Vec<bool> = list.strokes.iter().map(|stroke| stroke.leaves_nothing()).collect();
        assert_eq!(gone, [false, false, true, true, false]);
    }
}
