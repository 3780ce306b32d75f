//! Suggestions for a mistyped name.

/// Smallest similarity, from 0 to 1, of a name that is suggested for a word. clap uses the same value for commands and
/// options.
const MIN_SIMILARITY: f64 = 0.7;

/// The text `; did you mean NAME?` with the name that is most similar to `word`; empty if no name is similar.
pub fn suggestion_text<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let candidates = names
        .into_iter()
        .map(|name| (strsim::jaro(word, name), name))
        .filter(|(similarity, _)| *similarity > MIN_SIMILARITY);
    let best = candidates.max_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(String::new, |(_, name)| format!("; did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_similar_name_is_suggested_unless_all_are_dissimilar() {
        let names = ["stand", "walk", "arc-left", "arc-right"];
        assert_eq!(suggestion_text("wlak", names), "; did you mean `walk`?");
        assert_eq!(
            suggestion_text("arc left", names),
            "; did you mean `arc-left`?"
        );
        assert_eq!(suggestion_text("xyz", names), "");
        assert_eq!(suggestion_text("walk", []), "");
    }
}
