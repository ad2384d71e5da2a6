//! Search for nodes: fuzzy over names, aliases from other tools, and descriptions.

use std::path::PathBuf;
use std::sync::Arc;

use nucleo_matcher::pattern::{CaseMatching, Normalization, Pattern};
use nucleo_matcher::{Config, Matcher, Utf32Str};
use sabi_editing::command::NodeSource;
use sabi_engine::OpenGraph;
use sabi_engine::catalog::{Catalog, Entry, Faces};

use crate::action::LibraryKind;

/// Node or group that can be added.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    pub(crate) new: NodeSource,
    pub(crate) face: Arc<Entry>,
    /// Section of menus: a category, or the origin of a group.
    pub(crate) section: String,
}

/// Key of a favorite in settings.
pub(crate) fn favorite_key(new: &NodeSource) -> String {
    match new {
        NodeSource::Kind(kind) => kind.clone(),
        NodeSource::Group(group) => format!("group {group}"),
        NodeSource::Library(file) => file.display().to_string(),
    }
}

/// Group in a library file.
#[derive(Clone)]
pub(crate) struct LibraryGroup {
    pub(crate) library: LibraryKind,
    /// Folder inside the library that it lies in.
    pub(crate) category: Option<String>,
    /// Digest of the file and of those that it uses; none where one of them cannot be read.
    pub(crate) digest: Option<String>,
    pub(crate) file: PathBuf,
    pub(crate) graph: Arc<OpenGraph>,
    pub(crate) face: Arc<Entry>,
}

/// Everything that can be added, by section: the node kinds, the document's own groups that are named, and those of the library.
pub(crate) fn candidates(
    catalog: &Catalog,
    faces: &Faces,
    groups: &[String],
    library_groups: &[LibraryGroup],
) -> Vec<Candidate> {
    let kinds = catalog.entries().map(|entry| Candidate {
        new: NodeSource::Kind(entry.id.clone()),
        section: entry.category().to_owned(),
        face: entry.clone(),
    });
    let own = groups.iter().filter_map(|name| {
        Some(Candidate {
            new: NodeSource::Group(name.clone()),
            face: faces.of_group(name)?.clone(),
            section: "groups here".to_owned(),
        })
    });
    let in_library = library_groups.iter().map(|group| Candidate {
        new: NodeSource::Library(group.file.clone()),
        face: group.face.clone(),
        section: match (group.library, &group.category) {
            (LibraryKind::Sabi, Some(category)) => format!("effects: {category}"),
            (LibraryKind::Sabi, None) => "effects".to_owned(),
            (LibraryKind::Project, _) => "project library".to_owned(),
            (LibraryKind::User, _) => "library".to_owned(),
        },
    });
    kinds.chain(own).chain(in_library).collect()
}

/// Weights of matches: names count more than descriptions.
const LABEL: u32 = 8;
const ALIAS: u32 = 6;
const ID: u32 = 5;
const SUMMARY: u32 = 2;
/// Weight of a word in the description.
const DESCRIPTION: u32 = 1;
/// Factor for a whole word.
const WHOLE_WORD: u32 = 2;
/// Score of a whole word in a text: fuzzy matches in texts mean little.
const SUMMARY_SCORE: u32 = 40;

/// Candidates that match every word of a query, the best first; all of them in order for an empty query.
pub(crate) fn ranked<'c>(candidates: &'c [Candidate], query: &str) -> Vec<&'c Candidate> {
    let words: Vec<&str> = query.split_whitespace().collect();
    if words.is_empty() {
        return candidates.iter().collect();
    }
    let mut matcher = Matcher::new(Config::DEFAULT);
    let patterns: Vec<(Pattern, String)> = words
        .iter()
        .map(|word| {
            let pattern = Pattern::parse(word, CaseMatching::Ignore, Normalization::Smart);
            (pattern, word.to_lowercase())
        })
        .collect();
    let mut scored: Vec<(u32, &Candidate)> = candidates
        .iter()
        .filter_map(|candidate| Some((score(&mut matcher, &patterns, candidate)?, candidate)))
        .collect();
    scored.sort_by(|(one, a), (other, b)| other.cmp(one).then_with(|| a.face.label.cmp(&b.face.label)));
    scored.into_iter().map(|(_, candidate)| candidate).collect()
}

/// Sum of the best matches of all words; none where a word does not match.
fn score(matcher: &mut Matcher, patterns: &[(Pattern, String)], candidate: &Candidate) -> Option<u32> {
    let face = &candidate.face;
    let mut sum = 0;
    for (pattern, word) in patterns {
        let mut best = 0;
        let mut letters = Vec::new();
        let mut try_text = |text: &str, weight: u32, best: &mut u32| {
            letters.clear();
            let found = pattern.score(Utf32Str::new(text, &mut letters), matcher);
            // Shorter names rank before longer ones that begin alike.
            let found = found.map_or(0, |found| found * weight * 100 / (100 + text.chars().count() as u32));
            // "dirt" means the word and not the letters of "direction".
            let mut parts = text.split(|letter: char| !letter.is_alphanumeric());
            let is_whole = parts.any(|part| part.eq_ignore_ascii_case(word));
            *best = (*best).max(if is_whole { found * WHOLE_WORD } else { found });
        };
        try_text(&face.label, LABEL, &mut best);
        try_text(&face.id, ID, &mut best);
        for alias in &face.aliases {
            try_text(alias, ALIAS, &mut best);
        }
        let says = |text: &str| text.to_lowercase().contains(word.as_str());
        if says(&face.summary) {
            best = best.max(SUMMARY * SUMMARY_SCORE);
        } else if best == 0 && says(&face.description) {
            best = DESCRIPTION * SUMMARY_SCORE;
        }
        if best == 0 {
            return None;
        }
        sum += best;
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use sabi_engine::Kinds;

    use super::*;

    fn found(query: &str) -> Vec<String> {
        let catalog = Catalog::new(&Kinds::builtin());
        let candidates = candidates(&catalog, &Faces::default(), &[], &[]);
        ranked(&candidates, query)
            .iter()
            .map(|candidate| candidate.face.id.clone())
            .collect()
    }

    #[test]
    fn a_node_is_found_by_its_name_its_id_and_other_tools_names() {
        let first = [
            ("simplex", "noise/simplex"),
            ("smplx", "noise/simplex"),
            ("blur", "filter/blur"),
            ("levels", "adjust/levels"),
            ("voronoi", "noise/cells"),
            ("worley", "noise/cells"),
            ("fbm", "noise/simplex"),
            ("invert", "adjust/invert"),
            ("output material", "output/material"),
            ("curvature", "surface/curvature"),
            ("grunge", "noise/simplex"),
            ("principled", "source/material"),
            ("uniform color", "color/constant"),
            ("math", "math/mask"),
            ("bricks", "pattern/bricks"),
            ("herringbone", "pattern/tiles"),
            ("id map", "color/pick"),
            ("tile sampler", "noise/dots"),
            ("smart material", "effect/layer"),
            ("dirt", "relief/fill"),
            ("rust", "effect/layer"),
        ];
        for (query, id) in first {
            let found = found(query);
            assert!(
                found.iter().take(3).any(|known| known == id),
                "{query}: {:?}",
                &found[..found.len().min(5)]
            );
        }
    }

    #[test]
    fn every_word_has_to_match() {
        assert!(found("blend mask").contains(&"blend/mask".to_owned()));
        assert!(!found("blend zzzz").contains(&"blend/mask".to_owned()));
    }

    #[test]
    fn nothing_typed_shows_everything() {
        assert!(found("").len() > 40);
    }
}
