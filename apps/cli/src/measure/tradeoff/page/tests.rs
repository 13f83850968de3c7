//! A page of made-up figures.

use super::*;
use crate::measure::tradeoff::fixtures;
use serde_json::Value;
use std::io::Write as _;
use std::process::{Command, Stdio};

fn page() -> String {
    let provenance = fixtures::provenance();
    let page = Page {
        provenance: &provenance,
        effort: "Five rounds & </script> {{data}}.",
        truth: "Nobody knows.",
        clock: 25.4,
        scenes: &[fixtures::scene()],
        backends: &[("aabb", "a `tree`")],
    };
    page.html().unwrap()
}

/// The text between the tags of the element with these attributes.
fn element<'a>(page: &'a str, start: &str, end: &str) -> &'a str {
    page.split_once(start).unwrap().1.split_once(end).unwrap().0
}

#[test]
fn the_template_has_each_placeholder_once_and_nothing_is_from_elsewhere() {
    for placeholder in ["{{style}}", "{{script}}", "{{data}}", "{{tables}}"] {
        assert_eq!(TEMPLATE.matches(placeholder).count(), 1, "{placeholder}");
    }
    assert_eq!(TEMPLATE.matches("{{").count(), 4);
    assert!(!SCRIPT.contains("</script") && !SCRIPT.contains("{{"));
    for foreign in ["http:", "https:", "src=", "<link", "url(", "@import", "import("] {
        assert!(!page().contains(foreign), "{foreign}");
    }
    assert_eq!(page().matches("</script>").count(), 2);
}

#[test]
fn the_data_have_every_measurement() {
    let page = page();
    let data: Value = serde_json::from_str(element(&page, "id=\"data\">", "</script>")).unwrap();
    let scene = fixtures::scene();
    assert_eq!(data["effort"], "Five rounds & </script> {{data}}.");
    assert_eq!((&data["clock"], &data["exact_limit"]), (&25.4.into(), &16.0.into()));
    assert_eq!(data["settings"].as_array().unwrap().len(), SETTINGS.len());
    assert_eq!(data["settings"][0]["name"], "default");
    for (curve, json) in scene.sets[0].curves.iter().zip(data["scenes"][0]["sets"][0]["curves"].as_array().unwrap()) {
        assert_eq!(json["name"], curve.name.as_str());
        let points = json["points"].as_array().unwrap();
        assert_eq!(points.len(), curve.points.len());
        for (point, json) in curve.points.iter().zip(points) {
            assert_eq!((json["setting"].as_str(), json["queries"].as_u64()), (Some(&*point.setting), Some(100)));
            assert_eq!(json["nanoseconds"]["median"], point.nanoseconds.median);
            assert_eq!(json["errors"]["scaled"]["max"], point.errors.scaled.max);
            assert_eq!((&json["latency"]["max"], &json["build"]["bytes_per_primitive"]), (&1600.into(), &65.5.into()));
        }
    }
}

#[test]
fn a_reader_without_a_script_has_the_tables() {
    let page = page();
    let tables = element(&page, "<noscript>", "</noscript>");
    assert!(tables.contains("a &quot;scene&quot;, of two, 1x") && tables.contains("epsilon 0.1"), "{tables}");
}

/// Runs the script of the page with a document that keeps what is written into it. Each test of the script is an
/// expression, whose value is printed. Returns nothing where `node` is not installed.
fn run_script(page: &str, expressions: &[&str]) -> Option<Vec<String>> {
    let data = element(page, "id=\"data\">", "</script>");
    let document = "const elements = {};
        globalThis.document = {
          addEventListener() {},
          getElementById: (id) => (elements[id] ??= { value: '0', checked: true, innerHTML: '', textContent: '' }),
        };
        const html = (id) => elements[id].innerHTML || elements[id].textContent;";
    let printed = expressions.iter().map(|expression| format!("console.log({expression});\n"));
    let program = format!(
        "{document}\ndocument.getElementById(\"data\").textContent = {};\n{}\n{}",
        serde_json::to_string(data).unwrap(),
        SCRIPT,
        printed.collect::<String>()
    );
    let mut node = Command::new("node")
        .arg("-")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .ok()?;
    node.stdin.take().unwrap().write_all(program.as_bytes()).unwrap();
    let output = node.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect())
}

#[test]
fn the_script_draws_every_point() {
    let all = "Object.keys(elements).map(html).join(' ').replaceAll('\\n', ' ')";
    let marks = "html('plot').match(/class=\"dot\"/g).length";
    let Some(lines) = run_script(&page(), &[all, marks, "html('advice')", "html('why')"]) else {
        return;
    };
    let [all, marks, advice, why] = lines.try_into().unwrap();
    for word in [
        "Which index for a \"scene\", of two?",
        "aabb, epsilon 0.1: 500 ns, at most 10 % guaranteed, largest relative error 5.0e-2",
        // An error of rounding is none.
        "p2m, default: 100 ns, exact",
        "<td>66</td>",
        "<code>portable</code>",
        "a &lt;processor&gt;, fast",
        "Five rounds &amp; &lt;/script&gt;",
        "<dt>aabb</dt><dd>a <code>tree</code></dd>",
        "exact</text>",
        "5.4 million",
        "0 of 300 answers",
    ] {
        assert!(all.contains(word), "{word}: {all}");
    }
    assert_eq!(marks, "3");
    assert_eq!(advice, "For a million queries: aabb, 1,001 ns per query, exact");
    assert_eq!(
        why,
        "From 5.4 million queries on <code>p2m</code> takes less time in all, building included: 100 ns per query. No \
         setting that guarantees errors of up to 1 % is faster."
    );
}

#[test]
fn the_best_are_by_what_was_measured() {
    let best = |change: &str| {
        format!(
            "(() => {{ const set = structuredClone(data.scenes[0].sets[0]); {change};
               return NEEDS.map((need) => describe(fastest(set.curves, need.limit))).join('; '); }})()"
        )
    };
    let job = "JOBS.map(([n]) => costs(data.scenes[0].sets[0].curves)
                 .sort((a, b) => total(a, n) - total(b, n))[0].name).join()";
    let without_cells = "set.curves.pop(); const rough = set.curves[0].points[1]";
    let Some(lines) = run_script(
        &page(),
        &[
            &best(""),
            &best(without_cells),
            &best(&format!("{without_cells}; rough.setting = 'max visits 16'")),
            &best(&format!("{without_cells}; rough.errors.broken = 1")),
            job,
        ],
    ) else {
        return;
    };
    assert_eq!(lines[0], "p2m, 100 ns; p2m, 100 ns; p2m, 100 ns");
    // Without cells, a tenth is worth an epsilon, and a hundredth is not.
    assert_eq!(lines[1], "aabb, 1,001 ns; aabb, 1,001 ns; aabb epsilon 0.1, 500 ns");
    // A limit of visits has no guarantee, and neither has a setting whose answers broke it.
    assert_eq!(lines[2], "aabb, 1,001 ns; aabb, 1,001 ns; aabb, 1,001 ns");
    assert_eq!(lines[3], lines[2]);
    // Ten thousand queries do not pay for cells, a hundred millions do.
    assert_eq!(lines[4], "aabb,aabb,p2m");
}

#[test]
fn the_advice_names_the_rings_of_the_chart() {
    // A limit of visits that has no error here, and a certified setting that is the fastest exact one.
    let set = "const set = structuredClone(data.scenes[0].sets[0]); const points = set.curves[0].points;
        const add = (setting, median, error) => points.push({ ...points[0], setting,
          nanoseconds: { median, min: median, max: median },
          errors: { ...points[0].errors, relative: { max: error, p999: error }, scaled: { max: 1e14 * error, p999: 0 } } });
        add('certified', 90, 0); add('epsilon 0.01', 45, 0); add('epsilon 0.001', 60, 1e-4); add('max visits 16', 9, 0);
        const drawn = errorPlot(set.curves, () => true, MEASURES[0]);";
    let run = |expression: &str| format!("(() => {{ {set} return {expression}; }})()");
    // A ring is followed by its mark.
    let rings =
        "[...drawn.matchAll(/class=\"border\" cx=\"[^\"]*\" cy=\"[^\"]*\" r=\"9.5\"\\/><[^>]*label=\"([^\"]*)\"/g)]
        .map(([, note]) => note).join('; ')";
    let hollow =
        "[...drawn.matchAll(/class=\"dot hollow\"[^>]*label=\"([^\"]*)\"/g)].map(([, note]) => note).join('; ')";
    let columns = "[...drawn.matchAll(/middle\">([a-z ]+)</g)].map(([, name]) => name).join('; ')";
    let Some(lines) = run_script(&page(), &[&run("advice(set).join('; ')"), &run(rings), &run(hollow), &run(columns)])
    else {
        return;
    };
    assert_eq!(
        lines[0],
        "aabb with certified, 90 ns per query, exact; If errors of up to 1 % do no harm, `aabb` with `epsilon 0.01` \
         takes 45 ns, 2.0 times as fast."
    );
    assert_eq!(
        lines[1],
        "aabb, epsilon 0.01: 45 ns, at most 1 % guaranteed, no error seen; aabb, epsilon 0.001: 60 ns, at most 0.1 % \
         guaranteed, largest relative error 1.0e-4; aabb, certified: 90 ns, exact"
    );
    assert_eq!(lines[2], "aabb, max visits 16: 9 ns, no guarantee, no error seen");
    assert_eq!(lines[3], "exact; none seen; ns per query");
}

#[test]
fn totals_are_equal_where_it_breaks_even() {
    let costs = "const [brute, tree, cells, bad] = [[0, 1e-3], [0.1, 1e-6], [5, 2e-7], [6, 2e-6]]
                   .map(([build, query], i) => ({ name: i, build, query }));";
    let run = |expression: &str| format!("(() => {{ {costs} return {expression}; }})()");
    let Some(lines) = run_script(
        &page(),
        &[
            &run("Math.abs(total(tree, breakEven(tree, cells)) / total(cells, breakEven(tree, cells)) - 1) < 1e-12"),
            &run("[breakEven(cells, tree), breakEven(bad, tree), breakEven(tree, tree)].join()"),
            &run("turnsInWords([{ name: 'a', from: 0 }, { name: 'b', from: 12345 }])"),
            "[ticks(1, 20), ticks(1e-16, 2).length].concat([25000, 1.4e6, 0.5, 2e9].map(tickLabel), error(8.34e12))
               .join(' ')",
            "[12, 12345, 273499, 2e6, 3e9].map(count).join('; ')",
        ],
    ) else {
        return;
    };
    assert_eq!(
        lines,
        [
            "true",
            ",0,0",
            "`a`, then `b` from 12,300 queries on",
            "1,2,5,10,20 9 25k 1.4M 0.5 2e9 8.3e12",
            "12; 12,300; 273,000; 2.0 million; 3000 million"
        ]
    );
}
