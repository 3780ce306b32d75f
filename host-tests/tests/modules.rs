//! Tests of the dependencies between modules: no dependency is cyclic, and each layer of the core uses only lower
//! layers.

mod workspace;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use lizard_host_tests::root;
use workspace::list_crates;

/// Crates whose modules are not checked: some of these modules use each other in a cycle.
const UNCHECKED_CRATES: [&str; 3] = ["host-tests", "tools/physics", "tools/rules"];

/// The layers of the core, which are its top-level modules, from top to bottom. A layer may use the layers below.
/// docs/structure.md describes the layers.
const CORE_LAYERS: [&str; 6] = ["console", "control", "motion", "guard", "memory", "numbers"];

/// Folders whose `mod.rs` counts as a separate module, which must not be part of a cycle either. Each entry consists of
/// a crate and a path prefix.
const FOLDERS_WITH_ROOT_FILE: [(&str, &str); 2] = [
    ("crates/host", "crate::"),
    ("crates/host", "crate::commands::"),
];

/// For each module, the other modules of the same folder that it uses.
type Uses = BTreeMap<String, BTreeSet<String>>;

#[test]
fn no_modules_depend_on_each_other_in_a_cycle() {
    let mut use_count = 0;
    let mut crates = list_crates();
    crates.retain(|path| !UNCHECKED_CRATES.contains(&path.as_str()));
    assert!(crates.len() > 22, "{crates:?}");
    for crate_path in &crates {
        for folder in find_folders(&root().join(crate_path).join("src")) {
            let folder_name = (crate_path.as_str(), folder.path_prefix.as_str());
            let uses = folder.find_uses(FOLDERS_WITH_ROOT_FILE.contains(&folder_name));
            use_count += uses.values().map(BTreeSet::len).sum::<usize>();
            let cyclic_modules = find_cyclic_modules(uses);
            assert!(
                cyclic_modules.is_empty(),
                "{crate_path}, {}: these modules use each other in a cycle: {cyclic_modules:?}",
                folder.path_prefix
            );
        }
    }
    assert!(
        use_count > 200,
        "found only {use_count} uses of another module"
    );
}

#[test]
fn a_layer_of_the_core_uses_only_layers_below_it() {
    let core = find_folders(&root().join("crates/core/src")).remove(0);
    let uses = core.find_uses(false);
    for (index, layer) in CORE_LAYERS.into_iter().enumerate() {
        for other_layer in &uses[layer] {
            assert!(
                CORE_LAYERS[index..].contains(&other_layer.as_str()),
                "{layer} uses {other_layer}, which is not a lower layer"
            );
        }
    }
}

#[test]
fn a_cycle_is_found_without_modules_that_lead_to_or_from_it() {
    let parse_uses = |lines: &[(&str, &[&str])]| -> Uses {
        let name_set = |names: &[&str]| names.iter().map(ToString::to_string).collect();
        let parse_line = |&(name, used): &(&str, &[&str])| (name.to_string(), name_set(used));
        lines.iter().map(parse_line).collect()
    };
    let chain = parse_uses(&[("a", &["b", "c"]), ("b", &["c"]), ("c", &[])]);
    assert!(find_cyclic_modules(chain).is_empty());
    let cycle = parse_uses(&[
        ("above", &["a"]),
        ("a", &["b"]),
        ("b", &["c"]),
        ("c", &["a", "below"]),
        ("below", &[]),
    ]);
    assert_eq!(find_cyclic_modules(cycle), ["a", "b", "c"]);
}

#[test]
fn super_is_resolved_to_the_parent_module_and_items_of_a_root_file_are_found() {
    let text = "use super::{Link, status};\nuse super::super::recorder::Event;";
    assert_eq!(
        resolve_super(text, "crate::drive::console::"),
        "use crate::drive::console::{Link, status};\nuse crate::drive::recorder::Event;"
    );
    for (file, parent_path) in [
        ("drive/console/status.rs", "crate::drive::console::"),
        ("drive/console/mod.rs", "crate::drive::"),
        ("drive/mod.rs", "crate::"),
    ] {
        let actual = find_parent_path("crate::", Path::new(file));
        assert_eq!(actual, parent_path, "{file}");
    }
    let root = "mod menu;\npub fn run() {}\nconst KNOWN: u8 = 1;\nuse menu::Choice;";
    assert_eq!(find_item_names(root).collect::<Vec<_>>(), ["run", "KNOWN"]);
}

/// Repeatedly removes every module that uses no other module or that no other module uses. Returns the remaining
/// modules, which are part of a cycle or lie between two cycles.
fn find_cyclic_modules(mut uses: Uses) -> Vec<String> {
    loop {
        let previous_count = uses.len();
        let used_modules: BTreeSet<String> = uses.values().flatten().cloned().collect();
        uses.retain(|name, others| !others.is_empty() && used_modules.contains(name));
        let remaining_modules: BTreeSet<String> = uses.keys().cloned().collect();
        for others in uses.values_mut() {
            others.retain(|other| remaining_modules.contains(other));
        }
        if uses.len() == previous_count {
            return remaining_modules.into_iter().collect();
        }
    }
}

/// A folder of modules: a crate, or a module with submodules.
struct Folder {
    /// The path prefix of the modules' names, for example `crate::` or `crate::measures::`.
    path_prefix: String,
    /// The text of the file that declares the modules, without comments and tests.
    root_text: String,
    /// The directory that contains the modules' files.
    directory: PathBuf,
}

/// Finds all folders of modules in a crate, the crate itself first.
fn find_folders(source_directory: &Path) -> Vec<Folder> {
    let mut all_folders = vec![Folder {
        path_prefix: "crate::".to_owned(),
        root_text: read_code(&source_directory.join("lib.rs")),
        directory: source_directory.to_owned(),
    }];
    let mut next_index = 0;
    while let Some(folder) = all_folders.get(next_index) {
        let inner_folders = folder.find_modules().into_iter().filter_map(|module| {
            let module_folder = folder.directory.join(module);
            let root_text = read_code(&module_folder.join("mod.rs"))
                + &read_code(&module_folder.with_extension("rs"));
            let path_prefix = format!("{}{module}::", folder.path_prefix);
            module_folder.is_dir().then_some(Folder {
                path_prefix,
                root_text,
                directory: module_folder,
            })
        });
        let inner_folders: Vec<_> = inner_folders.collect();
        all_folders.extend(inner_folders);
        next_index += 1;
    }
    all_folders
}

impl Folder {
    fn find_modules(&self) -> BTreeSet<&str> {
        let lines = self.root_text.lines();
        lines.filter_map(parse_declared_module).collect()
    }

    /// Finds the uses among the folder's modules. A module and its submodules count as one module. If
    /// `includes_root_file` is true, `mod.rs` counts as another module. Tests do not count.
    fn find_uses(&self, includes_root_file: bool) -> Uses {
        let modules = self.find_modules();
        // A use of `crate::Name` counts as a use of the module from which the root file exports this name.
        let mut module_by_name: BTreeMap<&str, &str> =
            modules.iter().map(|name| (*name, *name)).collect();
        let items = self.root_text.split(';');
        for (_, path) in items.filter_map(|item| item.split_once("use ")) {
            if let Some((module_name, names)) = path.split_once("::")
                && let Some(module_name) = modules.get(module_name)
            {
                module_by_name.extend(split_words(names).map(|name| (name, *module_name)));
            }
        }
        let mut uses = Uses::new();
        if includes_root_file {
            module_by_name.extend(find_item_names(&self.root_text).map(|name| (name, ROOT_FILE)));
            let used = modules
                .iter()
                .filter(|module| self.root_text.contains(&format!("{module}::")));
            let used = used.map(ToString::to_string).collect();
            uses.insert(ROOT_FILE.to_owned(), used);
        }
        for module in &modules {
            let module_folder = self.directory.join(module);
            let code = read_code(&module_folder.with_extension("rs"));
            let mut text = resolve_super(&code, &self.path_prefix);
            for path in find_source_files(&module_folder) {
                let relative_path = path.strip_prefix(&self.directory);
                let relative_path = relative_path.expect("the path is in the folder");
                let parent_path = find_parent_path(&self.path_prefix, relative_path);
                text += &resolve_super(&read_code(&path), &parent_path);
            }
            let used = find_names_after(&text, &self.path_prefix).into_iter();
            let others = used
                .filter_map(|name| module_by_name.get(name))
                .filter(|other| *other != module);
            let others = others.map(ToString::to_string).collect();
            uses.insert(module.to_string(), others);
        }
        uses
    }
}

/// The name of a folder's root file in the uses of its modules.
const ROOT_FILE: &str = "(mod.rs)";

/// Finds the names of the functions, types and constants that a text defines.
fn find_item_names(text: &str) -> impl Iterator<Item = &str> {
    const KINDS: [&str; 6] = ["fn ", "struct ", "enum ", "trait ", "type ", "const "];
    text.lines().filter_map(|line| {
        let line = strip_visibility(line);
        let mut keywords = KINDS.iter();
        let name = keywords.find_map(|keyword| line.strip_prefix(keyword))?;
        split_words(name).next()
    })
}

/// Returns the path of the module that declares a file's module. The file's path is relative to the folder with
/// `path_prefix`.
fn find_parent_path(path_prefix: &str, relative_path: &Path) -> String {
    // `mod.rs` is the module of its folder.
    let own_name_count = 1 + usize::from(relative_path.ends_with("mod.rs"));
    let names: Vec<_> = relative_path.iter().collect();
    let mut parent_path = path_prefix.to_owned();
    for name in &names[..names.len() - own_name_count] {
        parent_path += &format!("{}::", name.display());
    }
    parent_path
}

/// Replaces every `super::` in a file's text with the path of the module to which it refers. `parent_path` is the path
/// of the file's parent module.
fn resolve_super(text: &str, parent_path: &str) -> String {
    let mut text = text.to_owned();
    let parts: Vec<&str> = parent_path.split_inclusive("::").collect();
    for level_count in (1..=parts.len()).rev() {
        let ancestor = parts[..parts.len() + 1 - level_count].concat();
        text = text.replace(&"super::".repeat(level_count), &ancestor);
    }
    text
}

/// Returns the name of the module that a line of a root file declares; `None` if the line declares no module.
fn parse_declared_module(line: &str) -> Option<&str> {
    let line = strip_visibility(line);
    line.strip_prefix("mod ")?.strip_suffix(';')
}

fn strip_visibility(line: &str) -> &str {
    line.trim_start_matches("pub(crate) ")
        .trim_start_matches("pub ")
}

/// Finds the names that follow a path such as `crate::`: a single name, or the names in braces.
fn find_names_after<'a>(text: &'a str, path: &str) -> BTreeSet<&'a str> {
    let parts_after = text.split(path).skip(1);
    parts_after
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => split_words(list.split('}').next().unwrap_or_default()).collect(),
            None => split_words(rest).take(1).collect::<Vec<_>>(),
        })
        .collect()
}

fn split_words(text: &str) -> impl Iterator<Item = &str> {
    let is_separator = |c: char| !(c.is_alphanumeric() || c == '_');
    text.split(is_separator).filter(|word| !word.is_empty())
}

/// Reads a file without its comments and its tests. Returns an empty string if the file is missing.
fn read_code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap_or_default();
    let text = match text.split_once("#[cfg(test)]\nmod tests {") {
        Some((code, _)) => code.to_string(),
        None => text,
    };
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    let lines: Vec<&str> = text.lines().filter(is_code).collect();
    let is_for_tests = |index: usize| index > 0 && lines[index - 1].trim() == "#[cfg(test)]";
    let indices = (0..lines.len()).filter(|index| !is_for_tests(*index));
    indices.map(|index| format!("{}\n", lines[index])).collect()
}

/// Finds the files in a module's folder and its subfolders, except for tests.
fn find_source_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let paths = entries.map(|entry| entry.expect("the folder entry is readable").path());
    let sources = paths.filter(|path| path.file_stem().is_some_and(|name| name != "tests"));
    sources
        .flat_map(|path| match path.is_dir() {
            true => find_source_files(&path),
            false => vec![path],
        })
        .collect()
}
