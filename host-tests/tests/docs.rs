//! Tests of the documentation: its pages name only existing tests, code items, links and files.

mod workspace;

use std::collections::BTreeSet;
use std::fs;
use std::mem::offset_of;
use std::path::{Path, PathBuf};

use lizard_core::numbers::curve::Table;
use lizard_core::numbers::gaits::{Gait, Wave};
use lizard_core::numbers::section::{Header, Numbers, REGION_BYTES, START_ADDRESS};
use lizard_host_tests::{read_file, root};
use workspace::list_crates;

/// Lists the paths of the files and folders in a folder. The path is relative to the root of the repository.
fn list_paths(folder: impl AsRef<Path>) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(root().join(folder)).expect("the folder is readable");
    entries.map(|entry| entry.expect("the folder entry is readable").path())
}

/// Returns the text between the first `start` and the next `end`.
fn find_text_between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let pieces = text
        .split_once(start)
        .and_then(|(_, rest)| rest.split_once(end));
    let (between, _) = pieces.unwrap_or_else(|| panic!("no {start:?} with {end:?} after it"));
    between
}

#[test]
fn every_fault_in_the_docs_names_an_existing_test() {
    let page = read_file("docs/faults.md");
    let table = find_text_between(&page, "## Each of them", "\n## ");
    let rows = table.lines().filter(|line| line.starts_with("| ")).skip(1);
    let mut row_count = 0;
    for row in rows {
        let pieces: Vec<&str> = row.split('`').collect();
        let [.., file, _, test_name, _] = pieces[..] else {
            panic!("the row names no test: {row}");
        };
        let folders = ["host-tests/tests", "crates/core/src"];
        let read = |folder: &&str| fs::read_to_string(root().join(folder).join(file)).ok();
        let source = folders.iter().find_map(read);
        let source = source.unwrap_or_else(|| panic!("the file {file} does not exist"));
        let is_found = source.contains(&format!("#[test]\nfn {test_name}()"));
        assert!(is_found, "{file} contains no test {test_name}");
        row_count += 1;
    }
    assert!(row_count > 20, "only {row_count} rows");
}

/// Returns the table rows `| offset | bytes | field |` of a type, in the order of the arguments. The code compiles only
/// if the arguments contain every field of the type.
macro_rules! rows {
    ($type:ident, $start:expr, [$($field:ident),+ $(,)?]) => {{
        let _ = |$type { $($field: _),+ }: &$type| ();
        [$(
            format!(
                "| {} | {} | `{}` |",
                $start + offset_of!($type, $field),
                field_size(|value: &$type| &value.$field),
                stringify!($field)
            )
        ),+]
    }};
}

/// Returns the size, in bytes, of the field that a getter returns.
fn field_size<T, F>(_: fn(&T) -> &F) -> usize {
    size_of::<F>()
}

#[test]
fn the_firmware_page_states_every_offset_and_size_in_a_robots_section() {
    let header_rows = rows!(
        Header,
        0,
        [magic, format, length, crc, name, hash, servo_hash]
    );
    let number_rows = rows!(
        Numbers,
        size_of::<Header>(),
        [
            ends,
            sliders,
            neutral_angles,
            calibration,
            needed_travel,
            limits,
            slew,
            supplies,
            curves,
            parts,
            rail_pin,
            slow_pace,
            pins,
            maps
        ]
    );
    let other_texts = [
        format!("| header | {} |", size_of::<Header>()),
        format!("| numbers | {} |", size_of::<Numbers>()),
        format!("| curves | {} each |", size_of::<Table>()),
        format!("| gaits | {} each |", size_of::<Gait>()),
        format!("| waveforms | {} each |", size_of::<Wave>()),
        format!("{START_ADDRESS:#x}"),
        format!("{:#x}", START_ADDRESS + REGION_BYTES),
        format!("{REGION_BYTES} bytes"),
    ];
    let page = read_file("docs/firmware.md");
    let mut missing_texts = [&header_rows[..], &number_rows, &other_texts].concat();
    missing_texts.retain(|text| !page.contains(text));
    assert!(
        missing_texts.is_empty(),
        "missing in docs/firmware.md:\n{}",
        missing_texts.join("\n")
    );
}

/// Returns the words of a text. As in crate paths, a word may contain dashes, underscores and slashes.
fn split_words(text: &str) -> BTreeSet<&str> {
    let is_separator = |c: char| !(c.is_alphanumeric() || "_-/".contains(c));
    text.split(is_separator).collect()
}

#[test]
fn the_license_lists_every_crate_with_or_without_libsimavr() {
    let license = read_file("LICENSE");
    let pieces = license.split_once("therefore licensed");
    let (_, text) = pieces.expect("LICENSE names the users of libsimavr");
    let lists = text.split_once("The firmware");
    let (simavr_users, others) = lists.expect("LICENSE has both lists");
    let [simavr_users, others] = [simavr_users, others].map(split_words);
    let crate_folders = list_crates();
    assert!(crate_folders.len() > 9, "{crate_folders:?}");
    for crate_folder in crate_folders {
        let manifest = read_file(format!("{crate_folder}/Cargo.toml"));
        let is_simavr = crate_folder == "crates/simulated-uno";
        let uses_simavr = is_simavr || manifest.contains("\nsimulated-uno = ");
        let crate_path = &*format!("{crate_folder}/");
        let is_simavr_user = is_simavr || simavr_users.contains(crate_path);
        let is_listed = [is_simavr_user, others.contains(crate_path)];
        let expected = [uses_simavr, !uses_simavr];
        assert_eq!(is_listed, expected, "LICENSE and {crate_folder}/Cargo.toml");
    }
}

#[test]
fn every_code_path_on_a_page_names_an_existing_item() {
    let mut item_count = 0;
    for (page, text) in read_pages() {
        let quoted_texts = text.split('`');
        let paths = quoted_texts.filter_map(|code| code.strip_prefix("lizard_"));
        for (crate_name, item) in paths.filter_map(|path| path.split_once("::")) {
            let path = format!("lizard_{crate_name}::{item}");
            let sources = read_sources(&root().join("crates").join(crate_name).join("src"));
            for name in item.split("::") {
                let is_declared = ["fn", "mod", "struct", "enum", "trait", "const", "type"]
                    .iter()
                    .any(|keyword| sources.contains(&format!("{keyword} {name}")));
                assert!(is_declared, "{}: {path} has no {name}", page.display());
            }
            item_count += 1;
        }
    }
    assert!(item_count > 0, "no page names a code item");
}

/// Reads the text of all Rust files in a folder and its subfolders.
fn read_sources(folder: &Path) -> String {
    let read = |path: PathBuf| match path.is_dir() {
        true => read_sources(&path),
        false => read_file(path),
    };
    list_paths(folder).map(read).collect()
}

/// Finds the files that contain a whole word in upper or lower case. `path` is a file, or a folder that is searched
/// with its subfolders.
fn find_files_with_word(path: &Path, word: &str) -> BTreeSet<PathBuf> {
    if path.is_dir() {
        return list_paths(path)
            .flat_map(|path| find_files_with_word(&path, word))
            .collect();
    }
    let text = read_file(path);
    let mut words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    let has_word = words.any(|candidate| candidate.eq_ignore_ascii_case(word));
    let path = path.strip_prefix(root());
    let path = path.expect("the path is below the root").to_path_buf();
    has_word.then_some(path).into_iter().collect()
}

/// Compares the files that CONTRIBUTING.md lists for a console command with the files that contain the command
/// `center`. This word occurs only as the command, while other commands, such as `deadman`, also occur in sentences. No
/// message contains `center`, so the test searches text.rs for `deadman` instead.
#[test]
fn a_console_command_is_in_at_most_seven_files_and_the_docs_name_them() {
    let page = read_file("CONTRIBUTING.md");
    let list = find_text_between(&page, "**A console command.**", "**A gait.**");
    let quoted = list.split('`').skip(1).step_by(2);
    let files = quoted.filter(|text| text.contains('/') && !text.contains(' '));
    let listed_files: BTreeSet<PathBuf> = files.map(PathBuf::from).collect();

    let mut files_with_command = BTreeSet::new();
    for (path, word) in [
        ("crates/core", "center"),
        ("tools/explore", "center"),
        ("tools/fuzz", "center"),
        ("tools/rules", "center"),
        ("docs/console.md", "center"),
        ("crates/core/src/console/text.rs", "deadman"),
    ] {
        files_with_command.extend(find_files_with_word(&root().join(path), word));
    }
    assert_eq!(listed_files, files_with_command);
    assert!(listed_files.len() <= 7, "{listed_files:?}");
}

/// Reads README.md, CONTRIBUTING.md and the pages in docs/, and returns their paths and texts.
fn read_pages() -> Vec<(PathBuf, String)> {
    let mut paths = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    paths.extend(list_paths("docs"));
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    let read_page = |path: PathBuf| {
        let text = read_file(&path);
        (path, text)
    };
    paths.into_iter().map(read_page).collect()
}

/// True if a page, which comes with its text, is in docs/.
fn is_in_docs((page, _): &(PathBuf, String)) -> bool {
    page.parent().is_some_and(|folder| folder.ends_with("docs"))
}

/// Returns the targets of a page's links and images: the texts between `](` and `)`, and the values of `src="..."`.
fn find_links(text: &str) -> Vec<&str> {
    let texts_between = |start: &'static str, end: char| {
        let pieces = text.split(start).skip(1);
        pieces.filter_map(move |rest| rest.split_once(end).map(|(link, _)| link))
    };
    texts_between("](", ')')
        .chain(texts_between("src=\"", '"'))
        .collect()
}

/// Returns the anchors that GitHub and mkdocs derive from a page's headings.
fn find_anchors(text: &str) -> Vec<String> {
    let to_anchor = |line: &str| {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let is_kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
        let letters: String = title.chars().filter(is_kept).collect();
        letters.replace(' ', "-")
    };
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings.map(to_anchor).collect()
}

#[test]
fn every_link_of_a_page_has_an_existing_target() {
    let mut link_count = 0;
    for (page, text) in read_pages() {
        for link in find_links(&text) {
            if link.contains("://") {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = match file {
                "" => page.clone(),
                file => page.parent().expect("the page is in a folder").join(file),
            };
            assert!(target.exists(), "{}: {link}", page.display());
            if !anchor.is_empty() {
                let anchors = find_anchors(&read_file(&target));
                let has_anchor = anchors.iter().any(|candidate| candidate == anchor);
                assert!(has_anchor, "{}: {link}", page.display());
            }
            link_count += 1;
        }
    }
    assert!(link_count > 60, "only {link_count} links");
}

#[test]
fn the_book_contains_every_page_of_docs_and_the_readme_is_short() {
    let book = read_file("mkdocs.yml");
    let count = |name: &str| book.matches(name).count();
    for (page, _) in read_pages().into_iter().filter(is_in_docs) {
        let name = page.file_name().expect("the page has a file name");
        let name = name.to_str().expect("the file name is UTF-8");
        let counts = [",", "]", "\n"].map(|end| count(&format!("{name}{end}")));
        assert_eq!(counts.iter().sum::<usize>(), 1, "{name}");
    }
    let readme = read_file("README.md");
    let line_count = readme.lines().count();
    assert!(line_count <= 150, "{line_count} lines");
}

#[test]
fn no_picture_is_on_two_pages_of_the_book() {
    let mut pictures = BTreeSet::new();
    // README.md is not a page of the book.
    for (page, text) in read_pages().into_iter().filter(is_in_docs) {
        let folder = page.parent().expect("the page is in a folder");
        let is_picture = |link: &&str| link.ends_with(".svg") || link.ends_with(".png");
        for link in find_links(&text).into_iter().filter(is_picture) {
            assert!(
                pictures.insert(folder.join(link)),
                "{}: {link} is also on another page",
                page.display()
            );
        }
    }
    assert!(pictures.len() > 5, "{pictures:?}");
}

#[test]
fn the_pages_name_the_current_version() {
    let manifest = read_file("Cargo.toml");
    let version = find_text_between(&manifest, "\nversion = \"", "\"");
    let changelog = read_file("CHANGELOG.md");
    let has_section = changelog.contains(&format!("\n## {version} ("));
    assert!(has_section, "CHANGELOG.md has no section for {version}");
    let mut version_count = 0;
    for (page, text) in read_pages() {
        // `lizard-0.2.0-page.zip`, `git tag v0.2.0`, `# lizard 0.2.0 tables`.
        for prefix in ["lizard-", "tag v", "# lizard "] {
            for text_after_prefix in text.split(prefix).skip(1) {
                let is_end = |c: char| !c.is_ascii_digit() && c != '.';
                let named_version = text_after_prefix.split(is_end).next().unwrap_or_default();
                if named_version.matches('.').count() == 2 {
                    let page = page.display();
                    assert_eq!(named_version, version, "{page}: {prefix}{named_version}");
                    version_count += 1;
                }
            }
        }
    }
    assert!(version_count > 10, "only {version_count} versions");
}
