//! Keywords of OBJ files whose statements are skipped.

/// Returns whether a keyword belongs to free-form curves and surfaces, superseded keywords included.
pub(super) fn is_free_form(keyword: &[u8]) -> bool {
    matches!(
        keyword,
        b"cstype"
            | b"deg"
            | b"bmat"
            | b"step"
            | b"curv"
            | b"curv2"
            | b"surf"
            | b"parm"
            | b"trim"
            | b"hole"
            | b"scrv"
            | b"sp"
            | b"end"
            | b"con"
            | b"bzp"
            | b"bsp"
            | b"cdc"
            | b"cdp"
            | b"res"
    )
}

/// Returns whether a keyword is one of OBJ that does not affect the geometry.
pub(super) fn is_known(keyword: &[u8]) -> bool {
    matches!(
        keyword,
        b"vt"
            | b"vn"
            | b"vp"
            | b"g"
            | b"s"
            | b"o"
            | b"mg"
            | b"usemtl"
            | b"mtllib"
            | b"usemap"
            | b"maplib"
            | b"bevel"
            | b"c_interp"
            | b"d_interp"
            | b"lod"
            | b"shadow_obj"
            | b"trace_obj"
            | b"ctech"
            | b"stech"
            | b"call"
            | b"csh"
    )
}
