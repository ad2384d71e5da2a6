//! Suggestions for misspelled words.

/// Words longer than this, in characters, are not compared.
const LENGTH_LIMIT: usize = 64;

/// Returns the candidate with the smallest edit distance to `word` (ignoring case), or one that starts with `word`; `None`
/// if no candidate is close. Of several with the same distance, the first is returned.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = letters(word)?;
    // One edit for every three letters is allowed, and one in short words.
    let limit = (word.len() / 3).max(1);
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let letters = letters(candidate)?;
            // Ids end in random characters, which the user may have left out.
            let begins = word.len() >= 3 && letters.starts_with(&word);
            // Each letter more or less is an edit: most candidates are left out by their length. A file may ask for very
            // many words.
            if !begins && letters.len().abs_diff(word.len()) > limit {
                return None;
            }
            let edits = distance(&word, &letters);
            // A word with every letter changed is not related.
            let related = edits <= limit && edits < word.len().max(letters.len());
            match (begins, related) {
                (true, _) => Some((edits.min(limit), candidate)),
                (false, true) => Some((edits, candidate)),
                (false, false) => None,
            }
        })
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, candidate)| candidate)
}

/// Maximum number of names that are all listed.
const MOST_LISTED: usize = 12;
/// Number of names that are listed if there are more than `MOST_LISTED`.
const NEAREST: usize = 5;

/// Returns advice for an unknown name: the name that was probably meant, or all names if they are few, or the most similar
/// ones. A clause, such as `did you mean 'wood'?`.
pub fn advice_on<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    if let Some(near) = nearest(word, names.iter().copied()) {
        return format!("did you mean '{near}'?");
    }
    let quoted = |names: &[&str]| {
        names
            .iter()
            .map(|name| format!("'{name}'"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    match names.len() {
        0 => "there is none".to_owned(),
        1..=MOST_LISTED => format!("there is {}", quoted(&names)),
        count => {
            let mut alike = names;
            let asked = letters(word).unwrap_or_default(); // A word that is too long resembles no name.
            // The sort is stable: of several equally similar names, the first comes first.
            alike.sort_by_cached_key(|name| {
                let letters = letters(name).unwrap_or_default(); // A name that is too long resembles no word.
                let is_part = letters.windows(asked.len().max(1)).any(|part| part == asked);
                (!is_part, distance(&asked, &letters))
            });
            alike.truncate(NEAREST);
            format!("there is {} and {} more", quoted(&alike), count - NEAREST)
        }
    }
}

/// Returns the lower-case letters of a word; `None` if it is empty or longer than any name.
fn letters(word: &str) -> Option<Vec<char>> {
    let letters: Vec<char> = word
        .chars()
        .take(LENGTH_LIMIT + 1)
        .flat_map(char::to_lowercase)
        .collect();
    (!letters.is_empty() && letters.len() <= LENGTH_LIMIT).then_some(letters)
}

/// Optimal string alignment distance: insertions, deletions, changes, and swaps of neighbors, each costing 1.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let change = last[j] + usize::from(a[i] != b[j]);
            let mut best = change.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                best = best.min(before_last[j - 1] + 1);
            }
            row.push(best);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typing_error_finds_the_intended_word() {
        let known = ["amount", "roughness", "mask", "worn_p2dd", "color"];
        for (word, found) in [
            ("amont", Some("amount")),
            ("Amount", Some("amount")),
            ("ruoghness", Some("roughness")),
            ("colour", Some("color")),
            ("worn", Some("worn_p2dd")),
            ("msk", Some("mask")),
            ("xy", None),
            ("", None),
            ("height", None),
        ] {
            assert_eq!(nearest(word, known), found, "{word}");
        }
        assert_eq!(nearest("a", ["b"]), None);
    }

    #[test]
    fn advice_is_the_intended_name_or_all_names_or_the_most_similar_ones() {
        let few = ["wood", "brass", "glass"];
        assert_eq!(advice_on("glas", few), "did you mean 'glass'?");
        assert_eq!(advice_on("x", few), "there is 'wood', 'brass', 'glass'");
        assert_eq!(advice_on("x", []), "there is none");
        let many: Vec<String> = (0..200).map(|at| format!("node_{at:03}_scratches")).collect();
        let told = advice_on("007", many.iter().map(String::as_str));
        assert!(told.starts_with("there is 'node_007_scratches', "), "{told}");
        assert!(told.ends_with(" and 195 more") && told.len() < 160, "{told}");
        let endless = "a".repeat(1_000_000);
        assert!(advice_on(&endless, many.iter().map(String::as_str)).ends_with(" and 195 more"));
    }

    #[test]
    fn a_very_long_word_is_not_compared() {
        assert_eq!(nearest(&"a".repeat(50_000_000), ["aaaa"]), None);
    }
}
