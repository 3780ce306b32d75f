//! docs/faults.md names tests that exist.

use std::fs;

use lizard_host_tests::root;

#[test]
fn every_fault_in_the_documentation_has_a_test_that_exists() {
    let page = fs::read_to_string(root().join("docs/faults.md")).expect("the page");
    let (_, table) = page.split_once("## Each of them").expect("the table");
    let (table, _) = table.split_once("\n## ").expect("what follows it");
    let rows = table.lines().filter(|line| line.starts_with("| ")).skip(1);
    let mut count = 0;
    for row in rows {
        let parts: Vec<&str> = row.split('`').collect();
        let [.., file, _, test, _] = parts[..] else {
            panic!("no test: {row}");
        };
        let places = [root().join("host-tests/tests"), root().join("core/src")];
        let source = places
            .iter()
            .find_map(|place| fs::read_to_string(place.join(file)).ok());
        let source = source.unwrap_or_else(|| panic!("no file {file}"));
        assert!(
            source.contains(&format!("#[test]\nfn {test}()")),
            "{file} has no {test}"
        );
        count += 1;
    }
    assert!(count > 20, "{count}");
}
