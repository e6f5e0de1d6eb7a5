"""Vocabulary of the grammar: macros, functions, relations and environments, including those that are refused."""

from __future__ import annotations

FUNCTIONS = {"ln": "log", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "sgn": "sign"}
FUNCTIONS |= {
    name: name
    for name in "sin cos tan exp log sinh cosh tanh min max sign sat abs asin acos atan sqrt atan2 diff d det".split()
}
RECIPROCALS = {"sec": "cos", "csc": "sin", "cot": "tan", "sech": "cosh", "csch": "sinh", "coth": "tanh"}
ACCENTS = {"dot": 1, "ddot": 2, "dddot": 3, "ddddot": 4}
MARKS = {"hat": "hat", "widehat": "hat", "bar": "bar", "overline": "bar", "tilde": "tilde", "widetilde": "tilde"}
MARKS |= {"check": "check", "breve": "breve", "underline": "under"}
STYLES = dict.fromkeys(
    "mathbf boldsymbol bm bold vec vect pmb overrightarrow bf textbf symbf symbfit mathbfit".split(), "vector"
)
BOLD = frozenset(STYLES)
"""Macros that set vectors."""
STYLES |= dict.fromkeys("mathcal mathscr mathfrak mathbb cal".split(), "cal") | {"mathtt": "tt"}
DECORATIONS = frozenset((*ACCENTS, *MARKS, *STYLES))
UPRIGHT = frozenset(
    "mathrm texttt textsl text textrm operatorname mathit textit mathsf mbox mathup textnormal textsf".split()
)
SPACES = frozenset(
    ", ; : ! quad qquad hspace thinspace enspace displaystyle textstyle scriptstyle nonumber notag limits nolimits "
    "left right middle big Big bigg Bigg bigl bigr Bigl Bigr biggl biggr Biggl Biggr mathstrut strut null hfill "
    "allowbreak nobreak negthinspace > space hline vphantom boldmath unboldmath noindent medspace thickspace "
    "mathnormal xspace tiny scriptsize footnotesize small normalsize large Large displaylimits "
    "vcentcolon IEEEyessubnumber IEEEyesnumber IEEEnonumber IEEEeqnarraynumspace".split()
) | {" "}
SKIPPED_GROUPS = frozenset("label tag vspace hspace phantom vphantom hphantom color eqno cite".split())
KEPT_GROUPS = frozenset("boxed underbrace overbrace underbracket overbracket mathord mathop mathrel smash".split())
EQUALS = frozenset(("equiv", "triangleq", "coloneqq", "doteq", "stackrel", "coloneq"))
TIMES = frozenset("cdot times ast odot bullet".split())
DOUBLE_SIGNS = {"pm": "either_sign", "mp": "other_sign"}
INTEGRALS = {"int": 1, "oint": 1, "iint": 2, "iiint": 3}
"""Integral signs -> the largest number of variables of integration."""
BETWEEN = {"otimes": "tensor", "circ": "composed", "wedge": "wedge"}
"""Signs between two factors other than multiplication -> the function that represents them in trees."""
OF_SETS = {"cup": "union", "cap": "intersection", "setminus": "without"}
"""Signs between two products -> the function that represents them in trees."""
SIGNS = TIMES | frozenset(("+", "-", "=", *DOUBLE_SIGNS, *BETWEEN, *OF_SETS))
OF_VECTORS = {"times": "cross", "cdot": "dot", "bullet": "dot"}
"""Multiplication signs -> the function that represents them in trees if they stand between vectors."""
RELATIONS = {
    **dict.fromkeys(("<", "lt"), "less"),
    **dict.fromkeys((">", "gt"), "greater"),
    **dict.fromkeys(("le", "leq", "leqslant"), "at_most"),
    **dict.fromkeys(("ge", "geq", "geqslant"), "at_least"),
    **dict.fromkeys(("ne", "neq"), "unequal"),
    **dict.fromkeys(("approx", "simeq", "cong"), "near"),
    **dict.fromkeys(("to", "rightarrow", "longrightarrow", "mapsto"), "tends"),
    **dict.fromkeys(("leftarrow", "gets"), "assigned"),
    "subset": "subset",
    "subseteq": "subset_or_same",
    "prec": "precedes",
    "preceq": "precedes_or_same",
    "succ": "follows",
    "succeq": "follows_or_same",
    "ll": "much_less",
    "gg": "much_greater",
    "sim": "similar",
    "propto": "proportional",
    "in": "element",
    "notin": "not_element",
}
"""Relation signs other than equality -> the function that represents them in trees."""
CONNECTIVES = frozenset(
    "implies iff Rightarrow Leftrightarrow Longrightarrow Longleftrightarrow therefore because forall".split()
)
"""Signs that connect relations and are treated like words between formulas."""
ELLIPSES = frozenset("ldots dots cdots vdots ddots dotsc dotsb".split())
OPTIMA = {
    **dict.fromkeys(("min", "minimize", "minimise"), "minimum"),
    **dict.fromkeys(("max", "maximize", "maximise"), "maximum"),
    "argmin": "argmin",
    "argmax": "argmax",
    "inf": "infimum",
    "sup": "supremum",
}
"""Operators over a subscript, such as a minimum -> the function that represents them in trees."""
ARGUMENT_OR_FACTOR = "this bracket could be an argument or a factor; write \\cdot before a factor"
PRIMED = "this prime could be a transpose or a derivative; write ^\\top or \\frac{d}{dt}"
OPERAND_ENDS = "without brackets, it is not clear where the operand of this operator ends"
BRACES = "braces could enclose a set here; write round brackets around a product"
EITHER_PRODUCT = "this could be a product of numbers or a cross product; set vectors in bold, or write \\cdot"
NOT_COMPARED = frozenset(RELATIONS.values()) | frozenset(OPTIMA.values())
NOT_COMPARED |= frozenset(
    "value cases list braces angled power raised limit sum product integral line_integral circulation cross dot "
    "skew".split()
)
NOT_COMPARED |= frozenset("given order between both equal times maps volume applied bracket variational".split())
NOT_COMPARED |= frozenset("closed_open open_closed boundary".split())
NOT_COMPARED |= frozenset("hessian transform open_interval binomial factorial".split())
NOT_COMPARED |= frozenset("gradient divergence curl laplacian indexed indexed_norm over in_unit differential".split())
NOT_COMPARED |= frozenset((*BETWEEN.values(), *OF_SETS.values(), *DOUBLE_SIGNS.values()))
"""Functions in trees that are read but cannot be compared with derived formulas."""
NOT_NUMBERS = frozenset(("ellipsis", "infinity", "otherwise", "nabla", "star", "dagger"))
"""Names in trees that do not denote numbers."""
REFUSED = {
    "not": "a negation",
    "exists": "a quantifier",
}
MATRICES = frozenset(
    "pmatrix bmatrix matrix Bmatrix vmatrix Vmatrix smallmatrix psmallmatrix bsmallmatrix array".split()
)
SYSTEMS = frozenset(
    "aligned split gathered alignedat cases dcases rcases align align* gather gather* alignat alignat* flalign "
    "flalign* eqnarray eqnarray* IEEEeqnarray equation equation* multline multline*".split()
)
OPENING = frozenset(("{", "lbrace", "lbrack", "langle"))
CLOSING = frozenset(("}", "rbrace", "rbrack", "rangle"))
"""Opening and closing brackets that are macros."""
BARS = frozenset(("lvert", "lVert", "|", "vert", "Vert"))
"""Vertical bars that are macros and may open."""
STARS, TRANSPOSED = frozenset(("*", "ast", "star")), frozenset(("T", "top", "intercal"))
NUMBERED_FUNCTIONS = frozenset("sin cos tan sinh cosh tanh log exp".split())
TIMES_OF_ANGLES, PLACES = frozenset(("t", "tau")), frozenset("x y z s theta phi varphi psi alpha beta".split())
FREQUENCIES = frozenset("i j k l m n p q omega Omega nu lambda".split())
"""Letters of frequencies: with one of `PLACES` after it, such a letter still belongs to the argument of a function."""
INDICES = frozenset("max min infty perp parallel oplus odot circ star ast prime ell".split())
"""Macros that are read as words in an index."""
AT_A_TIME = frozenset("t t_f t_0 t0 tf T t_1 t1 0 tau".split())
ATOMS = frozenset("binom sum prod frac tfrac dfrac cfrac sqrt lvert lVert partial lim nabla infty".split())
ATOMS |= ELLIPSES | OPENING | INTEGRALS.keys()
CONSTANT = ("constant", "const")
SPELLED = tuple(
    "arcsin arccos arctan sinh cosh tanh sign sqrt sin cos tan exp log sgn det min max sec csc cot ln".split()
)
"""Functions that look like products of letters without their backslash; longer names come first."""
CALLED = tuple("eig diag rank trace dim ker span adj sat sinc erf cov Cov var Var vec tr Tr mod grad div curl".split())
"""Names of functions that look like products of letters before a bracket."""
OPERATOR_NAMES = frozenset("Pr dim ker deg gcd hom lg".split())
"""Functions of unknown meaning for which LaTeX has a macro."""
UNKNOWN = frozenset("tr trace rank diag sinc sec csc cot Re Im erf sn cn dn am arg cov var mod SO SE".split())
"""Functions of unknown meaning that are printed upright."""
SAID = frozenset("and or if for where when with otherwise dan atau jika untuk dengan bila dimana".split())
SAID |= frozenset(("subject to", "such that", "s.t.", "s.t", "i.e.", "i.e", "since", "while", "as", "etc"))
SAID |= frozenset(
    "et ou si avec où pour quand donc soit lorsque und oder mit für wenn dove per con para cuando".split()
)
"""Words between formulas, in several languages."""
OTHERWISE = frozenset("else elsewhere lainnya sonst sinon altrimenti".split())
"""Words for the last of several cases, apart from otherwise itself."""
SHORT_WORDS = frozenset("in on at by of is".split())
"""Words between formulas that would be read as products of letters if they were not set upright."""
UNITS = frozenset(
    "m km cm mm s ms min h kg g N kN J W kW K A V Hz rad mrad deg m/s km/s m/s^2 rad/s kg/s "
    "Nm Pa kPa MPa GHz kHz MHz mol C T AU kWh rpm F L".split()
)
COUNTERS = frozenset("i j k l m n N M K".split())
"""Letters of which the index of a member of a sequence is composed."""
LAPSED = frozenset("phi varphi Phi varPhi psi Psi chi".split())
"""Letters of functions of elapsed time; a difference of times in brackets after such a letter is not a factor."""
ARGUED = LAPSED | frozenset("f F sigma".split())
"""Letters of functions; a product in brackets after such a letter is not a factor."""
SHIFTED = frozenset("f F x y z u w q X Y U".split())
"""Letters after which a bracket with time and another term, as in u(t - T), is not a factor."""
FIELDS, OPERATORS = frozenset("f g h F G X".split()), frozenset("D H J".split())
"""Letters of vector fields along which functions are differentiated, and of operators that act on functions."""
TRANSFORMS = "ELFZ"
"""Letters of transforms and expected values; braces after such a letter are not a factor."""
ANGLES = frozenset("theta vartheta phi varphi psi E M".split())
"""Letters of angles; a time after such a letter is not a factor of the argument."""
OF_ECCENTRICITIES = frozenset((2, 3, 4, 6, 8))
"""Exponents for which a power of e is a power of the eccentricity, not of the base of the natural logarithm."""
