//! Units of coordinate systems in well-known text.

use p2m_mixed::Unit;

/// Returns the unit of the horizontal coordinates from the well-known text of a `.prj` file or a LAS file.
pub(crate) fn unit(text: &str) -> Option<Unit> {
    let text = text.to_ascii_uppercase();
    let first = |text: &str, keywords: &[&str]| keywords.iter().filter_map(|keyword| text.find(keyword)).min();
    let Some(start) = first(&text, &["PROJCS", "PROJCRS", "PROJECTEDCRS"]) else {
        return first(&text, &["GEOGCS", "GEOGCRS", "GEODCRS"]).map(|_| Unit::Degree);
    };
    // A compound system also has a vertical part, whose unit may differ.
    let text = &text[start..];
    let heights = first(text, &["VERT_CS[", "VERTCS[", "VERTCRS[", "VERTICALCRS["]);
    let text = &text[..heights.unwrap_or(text.len())];
    // In version 2, ellipsoids and parameters have units, which come before the units of the axes. In version 1, the
    // unit of angles comes first, with its factor to radians.
    let axes = text.split_once("CS[CARTESIAN").map_or(text, |(_, axes)| axes);
    axes.split("UNIT[").skip(1).find_map(|rest| {
        let factor = rest.split(']').next()?.split(',').nth(1)?.trim().parse().ok()?;
        Unit::of_metres(factor)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_of_lengths_is_not_that_of_angles() {
        let geographic = r#"GEOGCS["WGS 84",DATUM["D"],PRIMEM["G",0],UNIT["degree",0.0174532925199433]]"#;
        let projected =
            |name: &str, factor| format!(r#"PROJCS["P",{geographic},PROJECTION["T"],UNIT["{name}",{factor}]]"#);
        assert_eq!(unit(geographic), Some(Unit::Degree));
        assert_eq!(unit(&projected("metre", 1.0)), Some(Unit::Metre));
        assert_eq!(unit(&projected("US survey foot", 0.304_800_609_601_219_2)), Some(Unit::SurveyFoot));
        assert_eq!(
            unit(r#"PROJCRS["P",BASEGEOGCRS["B",LENGTHUNIT["metre",1]],CS[Cartesian,2],LENGTHUNIT["foot",0.3048]]"#),
            Some(Unit::Foot)
        );
        assert_eq!((unit(""), unit(&projected("furlong", 201.168))), (None, None));
    }

    #[test]
    fn the_unit_of_heights_is_not_that_of_a_compound_system() {
        for (name, factor, expected) in
            [("furlong", 201.168, None), ("foot", 0.3048, Some(Unit::Foot)), ("metre", 1.0, Some(Unit::Metre))]
        {
            let plane = format!(r#"PROJCS["P",GEOGCS["G",UNIT["degree",0.0174532925199433]],UNIT["{name}",{factor}]]"#);
            let heights = |keyword: &str| format!(r#"{keyword}["H",VDATUM["D"],UNIT["metre",1.0]]"#);
            assert_eq!(unit(&format!(r#"COMPD_CS["C",{plane},{}]"#, heights("VERT_CS"))), expected);
            assert_eq!(unit(&format!("{plane},{}", heights("VERTCS"))), expected);
            assert_eq!(unit(&format!("{},{plane}", heights("VERTCS"))), expected);
            let axes = format!(r#"PROJCRS["P",CS[Cartesian,2],LENGTHUNIT["{name}",{factor}]]"#);
            let vertical = r#"VERTCRS["H",CS[vertical,1],LENGTHUNIT["metre",1]]"#;
            assert_eq!(unit(&format!(r#"COMPOUNDCRS["C",{axes},{vertical}]"#)), expected);
        }
    }
}
