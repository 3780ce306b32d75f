//! Suggestions for a mistyped name.

/// Similarity, from 0 to 1, that a suggested name must exceed. clap uses the same value for commands and options.
const SIMILARITY_THRESHOLD: f64 = 0.7;

/// Returns `; did you mean NAME?` with the name most similar to `word`; empty if no name is similar.
pub fn format_suggestion<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let candidates = names
        .into_iter()
        .map(|name| (strsim::jaro(word, name), name))
        .filter(|(similarity, _)| *similarity > SIMILARITY_THRESHOLD);
    let best = candidates.max_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(String::new, |(_, name)| format!("; did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_similar_name_is_suggested_if_any_is_similar() {
        let names = ["stand", "walk", "arc-left", "arc-right"];
        assert_eq!(format_suggestion("wlak", names), "; did you mean `walk`?");
        assert_eq!(
            format_suggestion("arc left", names),
            "; did you mean `arc-left`?"
        );
        assert_eq!(format_suggestion("xyz", names), "");
        assert_eq!(format_suggestion("walk", []), "");
    }
}
