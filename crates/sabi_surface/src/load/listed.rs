//! Lists of names in sentences.

/// Returns names as a list in a sentence, of many only the first: `` `a`, `b` and 3 more ``.
pub fn listed<'n>(names: impl Iterator<Item = &'n str>, most: usize) -> String {
    let mut quoted: Vec<String> = names.map(|name| format!("`{name}`")).collect();
    let more = quoted.len().saturating_sub(most);
    if more > 0 {
        quoted.truncate(most);
        quoted.push(format!("{more} more"));
    }
    match quoted.as_slice() {
        [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        quoted => quoted.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::listed;

    #[test]
    fn of_many_names_the_first_are_listed_and_the_others_counted() {
        let names = ["a", "b", "c", "d"];
        assert_eq!(listed(names[..0].iter().copied(), 3), "");
        assert_eq!(listed(names[..1].iter().copied(), 3), "`a`");
        assert_eq!(listed(names[..3].iter().copied(), 3), "`a`, `b` and `c`");
        assert_eq!(listed(names.into_iter(), 2), "`a`, `b` and 2 more");
    }
}
