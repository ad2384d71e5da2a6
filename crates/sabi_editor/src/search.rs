//! Search for nodes: fuzzy over names, aliases from other tools, and descriptions.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use nucleo_matcher::pattern::{CaseMatching, Normalization, Pattern};
use nucleo_matcher::{Config, Matcher, Utf32Str};
use sabi_editing::command::NodeSource;
use sabi_engine::OpenGraph;
use sabi_engine::catalog::{Catalog, Interface, Interfaces};
use sabi_nodes::label_of;

use crate::action::LibraryKind;

/// Node or group that can be added.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    pub(crate) new: NodeSource,
    pub(crate) interface: Arc<Interface>,
    /// Section of menus: a category, or the origin of a group.
    pub(crate) section: String,
    /// Key of the favorite in settings.
    pub(crate) favorite: String,
    /// Labels of the variants of a group, which it is found by, too.
    pub(crate) variants: Vec<String>,
}

impl Candidate {
    /// Returns whether a key in settings stands for this candidate. Earlier versions named files of libraries by their paths.
    pub(crate) fn is_favorite(&self, key: &str) -> bool {
        if self.favorite == key {
            return true;
        }
        let NodeSource::Library(file) = &self.new else {
            return false;
        };
        let inside = self.favorite.strip_prefix(SABI_PREFIX);
        file.as_path() == Path::new(key) || inside.is_some_and(|inside| is_of_earlier_release(Path::new(key), inside))
    }

    /// Place among the favorites.
    pub(crate) fn favorite_number(&self, favorites: &[String]) -> Option<usize> {
        favorites.iter().position(|key| self.is_favorite(key))
    }
}

/// Prefix of keys of Sabi's own effects, as links to them begin.
const SABI_PREFIX: &str = "sabi:";

/// Returns whether a path is that of a file in Sabi's library as another release has written it: into a folder that is named by
/// the first 16 digits of a hash of its contents.
fn is_of_earlier_release(path: &Path, inside: &str) -> bool {
    const DIGITS: usize = 16;
    let levels = Path::new(inside).components().count();
    let folder = path.ancestors().nth(levels).and_then(Path::file_name);
    let is_hash = |name: &str| name.len() == DIGITS && name.chars().all(|digit| digit.is_ascii_hexdigit());
    path.ends_with(inside) && folder.and_then(|name| name.to_str()).is_some_and(is_hash)
}

/// Group in a library file.
#[derive(Clone)]
pub(crate) struct LibraryGroup {
    pub(crate) library: LibraryKind,
    /// Folder inside the library that it lies in.
    pub(crate) category: Option<String>,
    /// Digest of the file and of those that it uses; `None` where one of them cannot be read.
    pub(crate) digest: Option<String>,
    pub(crate) file: PathBuf,
    pub(crate) graph: Arc<OpenGraph>,
    pub(crate) interface: Arc<Interface>,
}

impl LibraryGroup {
    /// Labels of its variants.
    fn variants(&self) -> Vec<String> {
        let graph = &self.graph.document.graph;
        graph.variants().keys().map(|name| label_of(name)).collect()
    }

    /// Key of the favorite: it begins with the name of the library, as links do, since the folder may move. Groups of a
    /// project have their paths as keys.
    fn favorite(&self) -> String {
        let prefix = match self.library {
            LibraryKind::Sabi => SABI_PREFIX,
            LibraryKind::User => "user:",
            LibraryKind::Project => return self.file.display().to_string(),
        };
        let name = self.file.file_name().unwrap_or(self.file.as_os_str()).to_string_lossy();
        match &self.category {
            Some(category) => format!("{prefix}{category}/{name}"),
            None => format!("{prefix}{name}"),
        }
    }
}

/// Everything that can be added, by section: the node kinds, the document's own groups that are named, and those of the library.
pub(crate) fn candidates(
    catalog: &Catalog,
    interfaces: &Interfaces,
    groups: &[String],
    library_groups: &[LibraryGroup],
) -> Vec<Candidate> {
    let kinds = catalog.entries().map(|entry| Candidate {
        new: NodeSource::Kind(entry.id.clone()),
        favorite: entry.id.clone(),
        section: entry.category().to_owned(),
        interface: entry.clone(),
        variants: Vec::new(),
    });
    let own = groups.iter().filter_map(|name| {
        Some(Candidate {
            new: NodeSource::Group(name.clone()),
            favorite: format!("group {name}"),
            interface: interfaces.of_group(name)?.clone(),
            section: "groups here".to_owned(),
            variants: Vec::new(),
        })
    });
    let in_library = library_groups.iter().map(|group| Candidate {
        new: NodeSource::Library(group.file.clone()),
        favorite: group.favorite(),
        interface: group.interface.clone(),
        variants: group.variants(),
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
const VARIANT: u32 = 4;
const SUMMARY: u32 = 2;
/// Weight of a word in the description.
const DESCRIPTION: u32 = 1;
/// Factor for a whole word.
const WHOLE_WORD: u32 = 2;
/// Score of a whole word in a text: fuzzy matches in texts mean little.
const SUMMARY_SCORE: u32 = 40;

/// Candidates that match every word of a query, the best first; all of them in order for an empty query. Of several words that
/// are all known, a candidate may also have only some ("wet stone" finds the stone and the water): those come after the ones
/// that have all as whole words.
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
    let matches: Vec<(Vec<WordMatch>, &Candidate)> = candidates
        .iter()
        .map(|candidate| (matched(&mut matcher, &patterns, candidate), candidate))
        .collect();
    let is_known = |at: usize| matches.iter().any(|(words, _)| words[at].is_whole);
    let are_all_known = words.len() > 1 && (0..words.len()).all(is_known);
    let mut found: Vec<(bool, u32, &Candidate)> = matches
        .iter()
        .filter(|(words, _)| {
            words.iter().all(|word| word.score > 0) || are_all_known && words.iter().any(|word| word.is_whole)
        })
        .map(|(words, candidate)| {
            let has_all = words.iter().all(|word| word.is_whole);
            (has_all, words.iter().map(|word| word.score).sum(), *candidate)
        })
        .collect();
    found.sort_by(|(one_has_all, one, a), (other_has_all, other, b)| {
        let by_score = (other_has_all, other).cmp(&(one_has_all, one));
        by_score.then_with(|| a.interface.label.cmp(&b.interface.label))
    });
    found.into_iter().map(|(_, _, candidate)| candidate).collect()
}

/// Returns the other name by which a query finds a candidate, where its own name does not have the words of the query.
pub(crate) fn found_alias<'c>(candidate: &'c Candidate, query: &str) -> Option<&'c str> {
    let label = candidate.interface.label.to_lowercase();
    let query = query.to_lowercase();
    let mut missing = query.split_whitespace().filter(|word| !label.contains(word));
    missing.find_map(|word| {
        let begins = |alias: &&String| {
            alias
                .to_lowercase()
                .split_whitespace()
                .any(|part| part.starts_with(word))
        };
        candidate.interface.aliases.iter().find(begins).map(String::as_str)
    })
}

/// Best match of a word in a candidate.
#[derive(Clone, Copy, Default)]
struct WordMatch {
    /// 0 where the word does not match.
    score: u32,
    /// True if it is a whole word of the name, the id, the aliases or the summary.
    is_whole: bool,
}

/// Best matches of all words.
fn matched(matcher: &mut Matcher, patterns: &[(Pattern, String)], candidate: &Candidate) -> Vec<WordMatch> {
    let interface = &candidate.interface;
    let of_word = |(pattern, word): &(Pattern, String)| {
        let mut best = WordMatch::default();
        let mut letters = Vec::new();
        let has_word = |text: &str| {
            // "dirt" means the word and not the letters of "direction".
            let mut parts = text.split(|letter: char| !letter.is_alphanumeric());
            parts.any(|part| part.eq_ignore_ascii_case(word))
        };
        let mut try_text = |text: &str, weight: u32, best: &mut WordMatch| {
            letters.clear();
            let found = pattern.score(Utf32Str::new(text, &mut letters), matcher);
            // Shorter names rank before longer ones that begin alike.
            let found = found.map_or(0, |found| found * weight * 100 / (100 + text.chars().count() as u32));
            let is_whole = has_word(text);
            best.score = best.score.max(if is_whole { found * WHOLE_WORD } else { found });
            best.is_whole |= is_whole;
        };
        try_text(&interface.label, LABEL, &mut best);
        try_text(&interface.id, ID, &mut best);
        for alias in &interface.aliases {
            try_text(alias, ALIAS, &mut best);
        }
        for variant in &candidate.variants {
            try_text(variant, VARIANT, &mut best);
        }
        let says = |text: &str| text.to_lowercase().contains(word.as_str());
        if says(&interface.summary) {
            best.score = best.score.max(SUMMARY * SUMMARY_SCORE);
            best.is_whole |= has_word(&interface.summary);
        } else if best.score == 0 && says(&interface.description) {
            best.score = DESCRIPTION * SUMMARY_SCORE;
        }
        best
    };
    patterns.iter().map(of_word).collect()
}

#[cfg(test)]
mod tests {
    use sabi_engine::Kinds;
    use sabi_engine::effect_library::effect_library;

    use super::*;
    use crate::library::GroupLibrary;

    /// Everything that can be added where there are Sabi's own effects.
    fn with_effects() -> Vec<Candidate> {
        let catalog = Catalog::new(&Kinds::builtin());
        let folder = effect_library(Path::new("")).expect("the library of the project");
        let mut library = GroupLibrary::default();
        let groups = library.groups(vec![(LibraryKind::Sabi, folder)], &catalog);
        candidates(&catalog, &Interfaces::default(), &[], groups)
    }

    fn found(query: &str) -> Vec<String> {
        let catalog = Catalog::new(&Kinds::builtin());
        let candidates = candidates(&catalog, &Interfaces::default(), &[], &[]);
        ranked(&candidates, query)
            .iter()
            .map(|candidate| candidate.interface.id.clone())
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
            // Names in other programs.
            ("flood fill", "surface/id"),
            ("anchor", "graph/reroute"),
            ("transform", "source/image"),
            ("mapping", "math/vector"),
            ("mixrgb", "blend/color"),
            ("color ramp", "color/gradient"),
            ("map range", "adjust/remap"),
            ("histogram scan", "adjust/coverage"),
            ("mix shader", "material/blend"),
            ("separate rgb", "color/split"),
            ("pointiness", "surface/curvature"),
            ("musgrave", "noise/simplex"),
            ("displacement", "effect/relief"),
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
    fn an_empty_query_shows_everything() {
        assert!(found("").len() > 40);
    }

    #[test]
    fn effects_are_found_by_words_for_their_look() {
        let all = with_effects();
        let wanted: [(&str, &[&str]); 8] = [
            ("bronze", &["Bare metal"]),
            // By its variants, too.
            ("hammered copper", &["Bare metal"]),
            ("rain", &["Rain runs", "Wet"]),
            ("chipped", &["Edge wear", "Broken edges", "Peeling paint"]),
            ("wet stone", &["Wet", "Cut stone"]),
            ("chipped paint", &["Peeling paint"]),
            ("verdigris", &["Patina"]),
            ("fingerprints", &["Smudges"]),
        ];
        for (query, names) in wanted {
            let first: Vec<&str> = ranked(&all, query)
                .iter()
                .take(6)
                .map(|found| found.interface.label.as_str())
                .collect();
            for name in names {
                assert!(first.contains(name), "{query}: {name} is not in {first:?}");
            }
        }
    }

    #[test]
    fn a_favorite_effect_stays_one_when_the_next_release_has_another_folder() {
        let group = |folder: &str, library| LibraryGroup {
            library,
            category: Some("weathering".to_owned()),
            digest: None,
            file: Path::new(folder).join("weathering/rust.sabi"),
            graph: Arc::new(OpenGraph::empty(PathBuf::from("none.sabi"))),
            interface: Catalog::new(&Kinds::builtin())
                .entry("noise/cells")
                .expect("a kind")
                .clone(),
        };
        let of = |folder: &str, library| {
            let found = candidates(
                &Catalog::default(),
                &Interfaces::default(),
                &[],
                &[group(folder, library)],
            );
            found.into_iter().next().expect("the group")
        };
        let rust = of("/data/effects/0123456789abcdef", LibraryKind::Sabi);
        assert_eq!(rust.favorite, "sabi:weathering/rust.sabi");
        let next = of("/data/effects/fedcba9876543210", LibraryKind::Sabi);
        let known = [
            "sabi:weathering/rust.sabi",
            // Keys of earlier versions are paths, even of the folder that the library was in before.
            "/data/effects/0123456789abcdef/weathering/rust.sabi",
            "/data/effects/fedcba9876543210/weathering/rust.sabi",
        ];
        for key in known {
            assert!(next.is_favorite(key), "{key}");
        }
        let others = [
            "/data/library/weathering/rust.sabi",
            "/data/effects/0123456789abcdef/finish/rust.sabi",
            "sabi:weathering/patina.sabi",
            "rust.sabi",
        ];
        for key in others {
            assert!(!next.is_favorite(key), "{key}");
        }
        let own = of("/data/library", LibraryKind::User);
        assert_eq!(own.favorite, "user:weathering/rust.sabi");
        assert!(own.is_favorite("/data/library/weathering/rust.sabi") && !own.is_favorite(known[1]));
        assert_eq!(next.favorite_number(&["x".to_owned(), known[1].to_owned()]), Some(1));
    }
}
