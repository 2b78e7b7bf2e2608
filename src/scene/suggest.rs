//! "Did you mean ...": the nearest of the words that are allowed.

/// The allowed word nearest to the one found, when it is near enough to be meant.
pub fn nearest<'a>(found: &str, allowed: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = found.to_lowercase();
    allowed
        .into_iter()
        .map(|word| (strsim::damerau_levenshtein(&folded, &word.to_lowercase()), word))
        .filter(|(distance, word)| {
            let long = word.chars().count().max(folded.chars().count());
            // a third of the letters may differ; of short words one may
            *distance <= (long / 3).max(1) && *distance < long
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, word)| word)
}

/// The note that goes with an unknown word: what may have been meant, and all that is allowed.
pub fn choice<'a>(found: &str, allowed: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let allowed: Vec<&str> = allowed.into_iter().collect();
    let mut notes = Vec::new();
    if let Some(word) = nearest(found, allowed.iter().copied()) {
        notes.push(format!("did you mean `{word}`?"));
    }
    match allowed.len() {
        0 => notes.push("there is none".to_string()),
        _ => notes.push(format!("allowed: {}", list(&allowed))),
    }
    notes
}

/// Words one after the other; a long list is cut.
pub fn list(words: &[&str]) -> String {
    const MOST: usize = 24;
    let mut text = words.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    if words.len() > MOST {
        text.push_str(&format!(" and {} more", words.len() - MOST));
    }
    text
}
