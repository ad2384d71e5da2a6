//! Suggestions for misspelled words.

/// Words longer than this, in characters, are not compared.
const LENGTH_LIMIT: usize = 64;

/// The candidate with the smallest edit distance to `word` (case is ignored), or one that begins with `word`; `None` when
/// none is near. Of several with the same distance, the first.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = letters(word)?;
    // One edit in three letters; short words may have one.
    let limit = (word.len() / 3).max(1);
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let letters = letters(candidate)?;
            let edits = distance(&word, &letters);
            // Ids end in a random tail that may be left out.
            let begins = word.len() >= 3 && letters.starts_with(&word);
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

/// Lower-case letters of a word; `None` when it is empty or longer than any name.
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
    fn a_slip_of_the_fingers_finds_its_word() {
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
    fn an_endless_word_costs_nothing() {
        assert_eq!(nearest(&"a".repeat(50_000_000), ["aaaa"]), None);
    }
}
