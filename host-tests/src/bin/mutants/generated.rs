//! Generates mutants: one for every operator, number and call in the firmware's code. After a shuffle, the first
//! mutants are a random sample.

use super::list::Mutant;

/// The folder whose files only read and produce console text. Any other file can move a servo or change a saved value.
const CONSOLE_FOLDER: &str = "crates/core/src/console/";

/// Parts of the paths of files in which no mutant is generated: these files do not run on the chip, or contain
/// generated tables.
const EXCLUDED_PATH_PARTS: [&str; 7] = [
    "tests",
    "autobaud/misread",
    "virtual_board",
    "sample",
    "bounds.rs",
    "section/content.rs",
    "section/seal.rs",
];

/// Operators, constants and methods, each with a wrong replacement.
const REPLACEMENTS: [(&str, &str); 19] = [
    (" == ", " != "),
    (" != ", " == "),
    (" < ", " <= "),
    (" > ", " >= "),
    (" <= ", " < "),
    (" >= ", " > "),
    (" && ", " || "),
    (" || ", " && "),
    (" + ", " - "),
    (" - ", " + "),
    (" += ", " -= "),
    (" -= ", " += "),
    (" << ", " >> "),
    (" >> ", " << "),
    ("true", "false"),
    ("false", "true"),
    (".min(", ".max("),
    (".max(", ".min("),
    ("saturating_sub(", "wrapping_add("),
];

/// True if mutants are generated in the file.
pub fn is_mutated(file: &str) -> bool {
    let folders = ["crates/core/src/", "src/board/", "crates/pulses/src/"];
    let is_excluded = EXCLUDED_PATH_PARTS.iter().any(|part| file.contains(part));
    file.ends_with(".rs") && folders.iter().any(|folder| file.starts_with(folder)) && !is_excluded
}

/// True if a mutation in the file can move a servo or change a saved value.
pub fn affects_servos_or_memory(file: &str) -> bool {
    !file.starts_with(CONSOLE_FOLDER)
}

/// Returns all mutants that can be generated in a file.
pub fn generate_mutants(file: &str, text: &str) -> Vec<Mutant> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let lines: Vec<&str> = code.lines().collect();
    let is_in_core = file.starts_with("crates/core/");
    let mut mutants = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        for (description, changed_line) in generate_changes(line) {
            // The old text must be unique in the file, so it includes previous lines if necessary.
            let mut first_index = index;
            while first_index > 0
                && text.matches(&lines[first_index..=index].join("\n")).count() > 1
            {
                first_index -= 1;
            }
            let mut new_lines = lines[first_index..index].to_vec();
            new_lines.push(&changed_line);
            mutants.push(Mutant {
                file: file.into(),
                description: format!("line {}: {description}", index + 1),
                package: is_in_core.then(|| "lizard-core".into()),
                is_generated: true,
                line: index + 1,
                old: lines[first_index..=index].join("\n"),
                new: new_lines.join("\n"),
                ..Mutant::default()
            });
        }
    }
    mutants
}

/// Returns all mutated forms of a line of code, each with a description.
fn generate_changes(line: &str) -> Vec<(String, String)> {
    let code = line.split("//").next().unwrap_or_default();
    let trimmed = code.trim();
    let starts_with = |prefixes: &[&str]| prefixes.iter().any(|prefix| trimmed.starts_with(prefix));
    let is_candidate = !starts_with(&["#", "use ", "const _", "type ", "impl"]);
    if !is_candidate || starts_with(&["assert!", "debug_assert!"]) || trimmed.contains('"') {
        return Vec::new();
    }
    let mut changes = Vec::new();
    let mut replace = |offset: usize, old: &str, new: &str| {
        let changed_line = format!("{}{new}{}", &line[..offset], &line[offset + old.len()..]);
        let description = format!("`{}` instead of `{}`", new.trim(), old.trim());
        changes.push((description, changed_line));
    };
    for (old, new) in REPLACEMENTS {
        for (offset, _) in code.match_indices(old) {
            replace(offset, old, new);
        }
    }
    for (offset, number) in find_numbers(code) {
        let next_number = number.parse::<u32>().map_or(1, |number| number + 1);
        replace(offset, number, &next_number.to_string());
    }
    let is_call = trimmed.ends_with(';') && trimmed.contains('(') && trimmed.contains('.');
    if is_call && !starts_with(&["let ", "return ", "pub ", "}", ")", "."]) {
        changes.push((format!("`{trimmed}` removed"), String::new()));
    }
    changes
}

/// Returns the decimal numbers in a line of code, each with its byte offset.
fn find_numbers(code: &str) -> Vec<(usize, &str)> {
    let is_separator = |c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.');
    let words = code.split(is_separator).filter(|word| !word.is_empty());
    let numbers = words.filter(|word| word.bytes().all(|byte| byte.is_ascii_digit()));
    let byte_offset = |word: &str| word.as_ptr() as usize - code.as_ptr() as usize;
    numbers.map(|word| (byte_offset(word), word)).collect()
}

/// Returns the 95 % Wilson confidence interval for the rate `caught / tried`.
pub fn wilson_interval(caught: usize, tried: usize) -> (f64, f64) {
    const Z: f64 = 1.96;
    let n = tried.max(1) as f64;
    let rate = caught as f64 / n;
    let middle = rate + Z * Z / (2.0 * n);
    let half_width = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + Z * Z / n;
    ((middle - half_width) / scale, (middle + half_width) / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed_texts(file: &str, text: &str) -> Vec<String> {
        let apply = |mutant: &Mutant| mutant.apply(text).expect("the old text is unique");
        generate_mutants(file, text).iter().map(apply).collect()
    }

    #[test]
    fn each_possible_change_of_a_line_is_generated_once() {
        let text =
            "fn f() {\n    a.b(1); // 2 < 3\n    if x < 17 && y {}\n}\n#[cfg(test)]\n1 < 2\n";
        let mut actual = changed_texts("crates/core/src/motion/frames.rs", text);
        actual.sort();
        let text_with = |old, new| text.replacen(old, new, 1);
        let mut expected = vec![
            text_with("    a.b(1); // 2 < 3", ""),
            text_with("b(1)", "b(2)"),
            text_with("x < 17", "x <= 17"),
            text_with("17", "18"),
            text_with("&&", "||"),
        ];
        expected.sort();
        assert_eq!(actual, expected);
    }

    #[test]
    fn a_repeated_line_is_identified_by_the_lines_before_it() {
        let text = "one\na = b + c;\ntwo\na = b + c;\n";
        let expected = [
            "one\na = b - c;\ntwo\na = b + c;\n",
            "one\na = b + c;\ntwo\na = b - c;\n",
        ];
        assert_eq!(changed_texts("crates/pulses/src/lib.rs", text), expected);
    }

    #[test]
    fn wilson_intervals_match_published_values() {
        // Newcombe 1998, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
        for (count, sample_size, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0000, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let (min, max) = wilson_interval(count, sample_size);
            assert!((min - low).abs() < 1e-4 && (max - high).abs() < 1e-4);
        }
    }
}
