//! Macros that define the operators of lanes by expressions of intrinsics.

/// Implements the operators of a vector type of f64. Each expression may use the operands `a` and `b`.
macro_rules! float_operators {
    ($type:ty, |$a:ident, $b:ident| {
        add: $add:expr, sub: $sub:expr, mul: $mul:expr, div: $div:expr, neg: $neg:expr,
    }) => {
        $crate::simd::operators::binary_operator!($type, Add, add, $a, $b, $add);
        $crate::simd::operators::binary_operator!($type, Sub, sub, $a, $b, $sub);
        $crate::simd::operators::binary_operator!($type, Mul, mul, $a, $b, $mul);
        $crate::simd::operators::binary_operator!($type, Div, div, $a, $b, $div);
        $crate::simd::operators::unary_operator!($type, Neg, neg, $a, $neg);
    };
}

/// Implements the operators of a mask type. Each expression may use the operands `a` and `b`.
macro_rules! mask_operators {
    ($type:ty, |$a:ident, $b:ident| { and: $and:expr, or: $or:expr, not: $not:expr, }) => {
        $crate::simd::operators::binary_operator!($type, BitAnd, bitand, $a, $b, $and);
        $crate::simd::operators::binary_operator!($type, BitOr, bitor, $a, $b, $or);
        $crate::simd::operators::unary_operator!($type, Not, not, $a, $not);
    };
}

/// Implements a binary operator.
macro_rules! binary_operator {
    ($type:ty, $trait:ident, $method:ident, $a:ident, $b:ident, $body:expr) => {
        impl std::ops::$trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self, other);
                $body
            }
        }
    };
}

/// Implements a unary operator.
macro_rules! unary_operator {
    ($type:ty, $trait:ident, $method:ident, $a:ident, $body:expr) => {
        impl std::ops::$trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self) -> Self {
                let $a = self;
                $body
            }
        }
    };
}

pub(in crate::simd) use {binary_operator, float_operators, mask_operators, unary_operator};
