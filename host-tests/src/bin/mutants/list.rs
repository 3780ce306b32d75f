//! Mutants, and the reader of their list, `mutants.txt`. The first lines of the list describe its format.

/// A mutant, which the tests should catch: a text replacement in one file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mutant {
    /// The file's path, relative to the root of the tree.
    pub file: String,
    /// The description of the mutation; in the list, its `wrong` line.
    pub description: String,
    /// The tests whose names contain this text run first; `None` if all tests run together.
    pub test_filter: Option<String>,
    /// The package whose own tests must catch the mutant, if the code also runs on the host; `None` if the code runs
    /// only in the firmware.
    pub package: Option<String>,
    /// True if the mutant was generated.
    pub is_generated: bool,
    /// The number of the entry's first line in the list or, for a generated mutant, of the changed line in the file.
    pub line: usize,
    /// The correct text, which is replaced.
    pub old: String,
    /// The text that replaces the correct text.
    pub new: String,
}

impl Mutant {
    /// Returns a mutant that changes nothing in a file of the core. `text` is the file's text.
    pub fn without_change_in_core(file: &str, text: String) -> Self {
        Self {
            file: file.into(),
            description: "no change".into(),
            package: Some("lizard-core".into()),
            is_generated: true,
            new: text.clone(),
            old: text,
            ..Self::default()
        }
    }

    /// Returns the file's text with the mutation.
    ///
    /// # Errors
    /// Fails if the old text does not occur exactly once in the file.
    pub fn apply(&self, text: &str) -> Result<String, String> {
        match text.matches(&self.old).count() {
            1 => Ok(text.replace(&self.old, &self.new)),
            0 => Err("the old text is missing".into()),
            count => Err(format!("the old text occurs {count} times")),
        }
    }
}

/// Parses the entries of `mutants.txt`.
///
/// # Errors
/// Fails if a line has an unknown key, or if an entry has no file, no `wrong` line or no old text.
pub fn parse(list: &str) -> Result<Vec<Mutant>, String> {
    let mut mutants = Vec::new();
    let mut open_entry: Option<Mutant> = None;
    for (index, line) in list.lines().chain([""]).enumerate() {
        let line_number = index + 1;
        if line.starts_with('#') {
            continue;
        }
        if line.is_empty() {
            if let Some(mutant) = open_entry.take() {
                let texts = [&mutant.file, &mutant.description, &mutant.old];
                if texts.into_iter().any(String::is_empty) {
                    let line = mutant.line;
                    return Err(format!(
                        "line {line}: an entry needs a file, a `wrong` line and an old text"
                    ));
                }
                mutants.push(mutant);
            }
            continue;
        }
        let mutant = open_entry.get_or_insert_with(|| Mutant {
            line: line_number,
            ..Mutant::default()
        });
        if let Some(old) = line.strip_prefix('-') {
            append_line(&mut mutant.old, old);
        } else if let Some(new) = line.strip_prefix('+') {
            append_line(&mut mutant.new, new);
        } else {
            let (key, value) = line.split_once(' ').unwrap_or((line, ""));
            match key {
                "file" => mutant.file = value.into(),
                "wrong" => mutant.description = value.into(),
                "test" => mutant.test_filter = Some(value.into()),
                "package" => mutant.package = Some(value.into()),
                _ => return Err(format!("line {line_number}: unknown key {key:?}")),
            }
        }
    }
    Ok(mutants)
}

/// Appends a line to a text, after a line feed unless the text is empty.
fn append_line(text: &mut String, line: &str) {
    if !text.is_empty() {
        text.push('\n');
    }
    text.push_str(line);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_replaces_its_old_text_only_if_it_occurs_exactly_once() {
        let list =
            "# a list\n\nfile a.rs\nwrong it is two\ntest one\n-let a = 1;\n-\n+let a = 2;\n";
        let mutants = parse(list).expect("the list is valid");
        let [mutant] = &mutants[..] else {
            panic!("{mutants:?}");
        };
        assert_eq!(mutant.line, 3);
        assert_eq!(mutant.test_filter.as_deref(), Some("one"));
        let changed_text = mutant.apply("let b = 0;\nlet a = 1;\n");
        assert_eq!(changed_text.as_deref(), Ok("let b = 0;\nlet a = 2;"));
        for (text, reason) in [
            ("let a = 3;\n", "missing"),
            ("let a = 1;\nlet a = 1;\n\n", "2 times"),
        ] {
            let result = mutant.apply(text);
            let error = result.expect_err("the old text must occur once");
            assert!(error.contains(reason), "{error}");
        }
    }

    #[test]
    fn the_error_for_an_invalid_list_names_the_line() {
        for (list, line) in [
            ("file a.rs\n-x\n+y\n", "line 1"),
            ("\nfile a\nwhat b\n", "line 3"),
        ] {
            let error = parse(list).expect_err("the list is invalid");
            assert!(error.starts_with(line), "{error}");
        }
    }
}
