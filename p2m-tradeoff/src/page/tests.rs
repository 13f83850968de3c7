//! A page of made-up figures.

use super::*;
use crate::fixtures;

fn page() -> String {
    let provenance = fixtures::provenance();
    let lines = vec![("aabb".to_owned(), vec![(1.0, 10.0), (2.0, 6.5)]), ("p2m".to_owned(), vec![(2.0, 3.0)])];
    let sweep = Sweep { title: "Threads".to_owned(), about: "Batches.".to_owned(), axes: ["threads", "ns"], lines };
    let page = Page {
        provenance: &provenance,
        effort: "Five rounds & <more>.",
        truth: "Nobody knows.",
        clock: 25.4,
        scenes: &[fixtures::scene()],
        sweeps: &[sweep],
        backends: &[("aabb", "a tree")],
    };
    assert_eq!(
        page.plots().unwrap().iter().map(|plot| plot.0.as_str()).collect::<Vec<_>>(),
        ["a--scene---of-two-1x.svg", "threads.svg"]
    );
    page.html().unwrap()
}

/// The tags of a page that are not closed, or not in their order.
fn unclosed(page: &str) -> Vec<String> {
    const VOID: [&str; 2] = ["meta", "!DOCTYPE"];
    let mut open: Vec<String> = Vec::new();
    for tag in page.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').expect("a tag ends");
        let name = tag.split([' ', '\n']).next().unwrap();
        match name.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop().as_deref(), Some(name), "closed in another order"),
            None if tag.ends_with('/') || VOID.contains(&name) => {}
            None => open.push(name.to_owned()),
        }
    }
    open
}

#[test]
fn every_tag_is_closed_and_nothing_is_from_elsewhere() {
    let page = page();
    assert_eq!(unclosed(&page), Vec::<String>::new());
    for foreign in ["http:", "https:", "src=", "<script", "<link", "url(", "@import"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    assert!(page.contains("Five rounds &amp; &lt;more&gt;."));
    assert!(page.contains("<code>portable</code>"), "{page}");
}

#[test]
fn every_point_and_every_note_is_there() {
    let page = page();
    for word in [
        "epsilon 0.1",
        "aabb, epsilon 0.1: 500 ns",
        "&lt;no&gt; reason",
        "<td>66</td>",
        "25 ns here",
        "p2m from 5.4 million",
        "exact",
    ] {
        assert!(page.contains(word), "{word}");
    }
    // Four of errors, latencies, totals; and the sweep.
    assert_eq!(page.matches("<svg").count(), 7);
    assert!(page.contains("<td>10.0</td>"), "{page}");
}

#[test]
fn tables_have_a_row_for_each_given_value() {
    let lines = vec![("a".to_owned(), vec![(1.0, 10.0), (2.0, 600.0)]), ("b".to_owned(), vec![(2.0, 1e-5)])];
    let sweep = Sweep { title: String::new(), about: String::new(), axes: ["threads", "ns"], lines };
    let (head, rows) = sweep_table(&sweep);
    assert_eq!(head, ["threads", "a", "b"]);
    assert_eq!(rows, [["1", "10.0", "-"], ["2", "600", "1.0e-5"]]);
}
