//! Lists of names in sentences.

/// Formats names as a list in a sentence. Of many names only the first are listed: `` `a`, `b` and 3 more ``.
pub fn listed<'n>(names: impl Iterator<Item = &'n str>, most: usize) -> String {
    joined(names.map(|name| format!("`{name}`")).collect(), most)
}

/// Formats words as a list in a sentence. Of many words only the first are listed.
pub(super) fn joined(mut words: Vec<String>, most: usize) -> String {
    let more = words.len().saturating_sub(most);
    if more > 0 {
        words.truncate(most);
        words.push(format!("{more} more"));
    }
    match words.as_slice() {
        [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        words => words.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::listed;

    #[test]
    fn of_many_names_the_first_are_listed_and_the_rest_is_counted() {
        let names = ["a", "b", "c", "d"];
        assert_eq!(listed(names[..0].iter().copied(), 3), "");
        assert_eq!(listed(names[..1].iter().copied(), 3), "`a`");
        assert_eq!(listed(names[..3].iter().copied(), 3), "`a`, `b` and `c`");
        assert_eq!(listed(names.into_iter(), 2), "`a`, `b` and 2 more");
    }
}
