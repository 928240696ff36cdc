//! "Did you mean": the nearest of a list of names.

/// Number of single-character insertions, deletions and replacements between two words.
pub fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut previous: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut row = vec![i + 1];
        for (j, to) in b.iter().enumerate() {
            let replaced = previous[j] + usize::from(from != *to);
            row.push(replaced.min(previous[j + 1] + 1).min(row[j] + 1));
        }
        previous = row;
    }
    previous[b.len()]
}

/// The candidate nearest to a mistyped word; `None` if none is near. A word that only lacks the rest of a candidate, such
/// as its unit, is near.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let near = (word.chars().count() / 3).max(2);
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let lower = candidate.to_lowercase();
            let begins = word.len() > 2 && (lower.starts_with(&word) || word.starts_with(&lower));
            let distance = if begins { 1 } else { edit_distance(&word, &lower) };
            (distance <= near && distance < lower.chars().count()).then_some((distance, candidate))
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// A sentence that names the nearest candidate, if any, and all of them.
pub fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
    let guess = nearest(word, candidates.clone());
    let quoted: Vec<String> = candidates.into_iter().map(|name| format!("`{name}`")).collect();
    match (guess, quoted.is_empty()) {
        (Some(guess), _) => format!("did you mean `{guess}`?"),
        (None, false) => format!("use one of {}", quoted.join(", ")),
        (None, true) => "there is none to choose from: define it first".to_owned(),
    }
}
