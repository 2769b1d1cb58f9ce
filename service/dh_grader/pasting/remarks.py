"""Decide whether a sentence of a student may change the meaning of the table beside it.

A sentence changes a table if it names a place of the table (a row, a cell, a sign, α₂) and says
that this place is wrong, doubtful or to be replaced. It also does if it asks not to grade the
table, announces a correction, or gives a cell another value than the table. The sentence may be in
English, German, Spanish, French or Chinese. All other sentences are harmless.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from dh_grader.regex import regex
from dh_grader.slices import checkpoint


def _words(latin: str, chinese: str = "") -> re.Pattern[str]:
    # Chinese has no blanks between words.
    pattern = rf"(?<![^\W_])(?:{latin})(?![^\W_])"
    return regex(f"{pattern}|{chinese}" if chinese else pattern, re.IGNORECASE)


# --- The places of a table


_ORDINAL: Final = (
    r"(?:first|second|third|fourth|fifth|sixth|last|final|[1-9](?:st|nd|rd|th|\.|e|è?me|ère|ª|º)"
    r"|(?:erst|zweit|dritt|viert|fünft|sechst|letzt|vorletzt)e[nrs]?"
    r"|primer[ao]?|segund[ao]|tercer[ao]?|cuart[ao]|quint[ao]|sext[ao]|[uú]ltim[ao]s?"
    r"|premi(?:er|ère)|deuxième|seconde?|troisième|quatrième|cinquième|sixième|derni(?:er|ère)s?)"
)
_LINES: Final = (
    r"(?:rows?|lines?|columns?|cells?|entry|entries|zeilen?|reihen?|spalten?|zellen?|einträge?"
    r"|eintrag|filas?|columnas?|celdas?|rengl[oó]n(?:es)?|lignes?|colonnes?|cellules?)"
)
_LINKS: Final = (
    r"(?:links?|joints?|frames?|gelenke?s?|glied(?:er|es)?|achsen?|eslab[oó]n(?:es)?"
    r"|articulaci[oó]n(?:es)?|articulations?|segments?|liaisons?)"
)
_LETTER: Final = r"(?:\\?alph?a|\\?alfa|\\?theta|th|[adαθ])"
_NUMBER: Final = r"(?:(?:no\.?|nr\.?|number|nummer|n°|número)\s?)?\d"
_AND: Final = r"\s{0,2}(?:and|und|y|e|et|with|mit|con|avec|/|&|<->|↔|和|与|跟)\s{0,2}"


def _counted(things: str) -> str:
    return (
        rf"{things}\s?{_NUMBER}"
        rf"|{_ORDINAL}(?:{_AND}{_ORDINAL})?\s(?:(?:two|three|beiden|zwei|dos|deux|dh)\s)?{things}"
        rf"|{things}\s{_ORDINAL}|(?:the|both|all|my|die|beiden?|alle|las|los|ambas|les)\s"
        rf"(?:(?:two|last|beiden|dos|deux)\s)?{things}"
    )


_CHINESE_NUMBER: Final = r"第?\s?[\d一二三四五六七两]\s?(?:个)?"
# A row, a column or a cell, or a parameter with the number of its row.
_CELL: Final = _words(
    _counted(_LINES)
    + rf"|{_LETTER}_?\s?\{{?\d\}}?|{_LETTER}{_AND}{_LETTER}"
    + rf"|{_LETTER}[- ](?:column|row|value|spalte|wert)s?"
    + rf"|(?:columna|colonne|valor|valeur|column|spalte)\s(?:de\s)?{_LETTER}"
    + r"|(?:this|that|these|those|which|diese[rs]?|est[aeo]s?|cette|ces?)"
    rf"\s(?:one|{_LINES})",
    rf"(?:{_CHINESE_NUMBER}|最后|[这该倒整])(?:一|数第[\d一二三])?\s?(?:行|列|格|项|个值|参数)"
    rf"|[αθ]\s?_?\{{?\d|(?<![a-z])[ad]\s?_?\d|[adαθ]\s?(?:和|与|跟|、)\s?[adαθ]|[αθad]\s?(?:列|值)",
)
_LINK: Final = _words(
    _counted(_LINKS), rf"{_CHINESE_NUMBER}(?:连杆|关节|杆)|(?:连杆|关节|杆件)\s?\d"
)
# A property of cells: their signs, or a parameter by its name.
_PROPERTY: Final = _words(
    r"signs?|minus(?:es|\ssigns?)?|vorzeichen|signos?|signes?|moins|menos|twist|verdrehung|verwindung"
    r"|offset|alpha|theta|alfa|α|θ|torsi[oó]n|torsion|angles?|winkel|[aá]ngulos?|lengths?|längen?"
    r"|longitud(?:es)?|longueurs?|values?|werte?s?|valor(?:es)?|valeurs?|units?|einheit(?:en)?"
    r"|unidad(?:es)?|unités?|order|reihenfolge|orden|ordre|numbers?|zahl(?:en)?"
    rf"|{_LINES}",
    "符号|正负号|负号|扭角|偏距|偏置|转角|长度|角度|单位|顺序|数值|[αθ]",
)
_TABLE: Final = _words(
    r"(?:dh[- ]?)?(?:table|tabelle|tabla|tableau)|results?|answers?|solutions?|lösung|antwort"
    r"|ergebnis|respuesta|solución|résultats?|réponse|(?:this|that|diese?|este|ce)\s(?:file|sheet"
    r"|upload|datei|blatt|archivo|hoja|fichier)|wrong\s(?:file|sheet|version)",
    "表格?|答案|结果|文件",
)

# --- What is said about a place


_NOT: Final = r"(?:not|never|\w{2,6}n['’]?t|cannot)"
# It is wrong.
_WRONG: Final = _words(
    rf"wrong(?:ly)?|incorrect(?:ly)?|{_NOT}\s(?:\w{{1,12}}\s)?(?:correct|right|true|valid)"
    r"|mistakes?|mistaken(?:ly)?|errors?|erroneous(?:ly)?|typos?|misprint|messed\sup|misread"
    r"|falsch\w{0,2}|fehlerhaft\w{0,2}|fehler|irrtümlich|irrtum|versehentlich|aus\sversehen"
    r"|(?:tipp|schreib|rechen|vorzeichen|abschreib)fehler|unrichtig|verschrieben|verrechnet|vertan"
    r"|stimm(?:t|en)\s(?:\w{1,12}\s){0,2}nicht|nicht\s(?:\w{1,12}\s)?(?:richtig|korrekt)"
    r"|est[aá]n?\s(?:muy\s)?mal|mal\s(?:puest|escrit|copiad|calculad|hech)\w{1,2}|equivocad\w{1,2}"
    r"|equivoqu\w{1,3}|incorrect[oa]s?|err[oó]ne\w{1,2}|error(?:es)?|errata|falso"
    r"|no\s(?:es|est[aá]n?|son)\s(?:correct\w{1,2}|bien)|no\svan?"
    r"|faux|fausses?|fautes?|erreurs?|erron\w{1,3}|inexact\w{0,2}|trompée?"
    r"|(?:n['’]est|n['’]était|ne\ssont)\spas\s(?:\w{1,12}\s)?(?:juste|correct|bon|exact)\w{0,3}",
    "错|不对|不正确|有误|搞反|有问题",
)
# It is exchanged or turned over, which axes of robots also are.
_TURNED: Final = _words(
    r"swapp?ed|exchanged?|interchanged?|switched|reversed|inverted|transposed|flipped|confused"
    r"|mix(?:ed)?[ -]?up|mixed|(?:the\s)?other\sway\s(?:a?round)?|upside\sdown|shifted|opposite"
    r"|(?:other|different|ander\w{1,2}|otro|autre)\s(?:sign|vorzeichen|signo|signe)"
    r"|backwards|misplaced|in\sthe\swrong\sorder"
    r"|vertausch\w{1,3}|verwechsel\w{1,3}|verkehrt\w{0,3}|umgekehrt\w{0,2}|verrutscht|verschoben"
    r"|intercambi\w{1,5}|invertid\w{1,2}|invertí|confund\w{1,3}|cambiad\w{1,2}|al\srevés"
    r"|inversée?s?|interverti\w{0,2}|échangée?s?|permutée?s?|confondue?s?|mélangée?s?|à\sl['’]envers|décalée?s?",
    "写反|弄反|反了|颠倒|混淆|[搞弄]混|对调|互换|交换|错位|相反",
)
# Something is missing, superfluous or doubtful.
_DOUBTFUL: Final = _words(
    r"forgot(?:ten)?|missed|missing|omitted|left\sout|lacks?|superfluous|redundant|too\smany"
    r"|sorry|oops|my\sbad|apolog\w{1,5}|actually|in\sfact|in\sreality"
    rf"|{_NOT}\s(?:\w{{1,12}}\s)?(?:mean|belong|count|intended)|unclear|doubt(?:s|ful)?"
    r"|maybe|perhaps|possibly|probably|might|guess(?:es|ed|ing)?|lost|instead"
    r"|rather\sthan"
    r"|vergessen|verloren|fehlt|fehlen|ausgelassen|übersehen|überflüssig|zu\sviel|sorry|entschuldig\w{2,4}"
    r"|eigentlich|tatsächlich|vielleicht|evtl|vermutlich"
    r"|wahrscheinlich|geraten|stattdessen|sondern|statt|anstatt|anstelle"
    r"|fraglich|zweifel\w{0,4}|hinfällig|ungültig"
    r"|olvid\w{1,3}|faltan?|faltó|falta\w{0,3}|sobran?|perd[oó]n|lo\ssiento|disculp\w{1,4}"
    r"|en\srealidad|quiz[aá]s?|tal\svez|a\slo\smejor|dud\w{1,3}"
    r"|en\s(?:lugar|vez)\sde|sino"
    r"|oubli\w{1,4}|manque\w{0,3}|en\strop|désolée?|pardon|en\sfait|en\sréalité"
    r"|peut-être|dout\w{1,3}|au\slieu|plutôt",
    "忘|漏|缺|少了|少写|少个|多了|多写|多余|抱歉|对不起|不好意思|其实|实际上?|也许|可能|大概|或许"
    "|而不是|不是.{1,12}[，,]?\\s?而?是|代替|作废|无效|没写",
)
# The student is not sure, whether or not an "if" follows.
_UNSURE: Final = _words(
    rf"{_NOT}\s(?:\w{{1,12}}\s)?(?:sure|certain)|unsure|uncertain|no\sidea|don['’]?t\sknow"
    r"|unsicher|nicht\s(?:\w{1,12}\s)?sicher|weiß\s(?:\w{1,12}\s)?nicht|keine\sahnung"
    r"|no\s(?:estoy|estamos|es)\s(?:muy\s)?segur\w{1,2}|no\ssé|ni\sidea"
    r"|pas\s(?:\w{1,9}\s)?(?:s[ûu]re?s?|certaine?s?)|ne\ssais\s(?:pas|plus)|aucune\sidée"
    r"|double[- ]?check|to\scheck|check\s(?:this|again|it)|verify|todo|tbd|fixme|(?:über)?prüfen"
    r"|revisar|comprobar|verificar|vérifier",
    "待(?:定|确认|查)|不(?:太|是很)?(?:确定|肯定|知道|清楚)|没把握",
)
# It should be different …
_MODAL: Final = _words(
    r"should|must|ought|(?:has|have|had|supposed|meant)\sto|needs?|shall"
    r"|muss|müssen|müsst\w{1,3}|soll(?:te|ten|en)?|gehört|gehören|lautet|heißt|richtig\swäre|wäre"
    r"|deb[eí]\w{0,4}|tien\w{1,2}\sque|tendría\w?\sque|hay\sque|ha\sde|sería"
    r"|doi(?:t|vent)|devrai(?:t|ent)|devait|faut|faudrait",
    "应[该当为是]|应|需要?|必须|得是|要改|该是",
)
# … as this value says.
_VALUE: Final = (
    r"(?:[-+−–±]?\s?(?:\d|π|\\?pi(?![^\W_])|[.,]\d)|(?:zero|null|cero|zéro|negativ\w{0,2}|négati\w{1,3}|nul(?:le)?"
    r"|positiv\w{0,2}|positi\w{1,3}|negated|swapped|removed|deleted|ignored|exchanged|empty|leer|minus"
    r"|menos|moins|vertauscht|gestrichen|swap|omitted|doubled|halved|opposite|different|anders|other)"
    rf"(?![^\W_])|{_LETTER}_?\d|[adl]_?\d|零|负|正"
    rf"|(?:nach|into|to|in)\s(?:(?:die|the)\s)?(?:(?:spalte|column)\s)?{_LETTER}(?![^\W_]))"
)
_GIVES: Final = regex(
    rf"(?:[^.;]|\.(?=\d)){{0,40}}?(?<![A-Za-z0-9])(?P<value>{_VALUE})", re.IGNORECASE
)
# A person is asked to leave it out, or to do something else with it.
_DROP: Final = (
    r"ignore|disregard|skip|delete|remove|cancel|drop|strike|scratch|cross\s(?:it\s)?out|discard"
    r"|(?:ignorier|streich|lösch|entfern|verwerf|weglass|überspring|vergess)(?:en|e|t|)"
    r"|ignor(?:ar|e|en|ad)|omit(?:ir|a|an)|elimin(?:ar|e|en)|borr(?:ar|e|en)|quit(?:ar|e|en)|descart(?:ar|en?)"
    r"|tach(?:ar|e|en)|ignore[rz]|supprime[rz]|efface[rz]|raye[rz]|enleve[rz]|enlève|retire[rz]|barre[rz]"
    r"|oublie[rz]"
)
_DROP_IN_CHINESE: Final = "忽略|无视|跳过|删[除掉去]|去掉|划掉"
_DROPS: Final = _words(_DROP, _DROP_IN_CHINESE)
_REQUEST: Final = _words(
    rf"{_DROP}|swap|exchange|interchange|switch|flip|invert|reverse|negate|change|replace|correct"
    r"|fix|adjust|modify|edit|insert|append|add|multiply|divide|read|use|take|put|move|treat|count"
    r"|(?:ver)?tausch(?:en|e|t)|(?:aus)?wechsel[ne]|ändern?|ändere|ersetz(?:en|e|t)|korrigier(?:en|e|t)"
    r"|ergänz(?:en|e|t)|einfügen|einsetzen|hinzufügen|umdrehen|umkehren|addieren|multiplizieren|negieren"
    r"|lesen|nehmen|verwenden|(?:dazu)?denken|lies|nimm|setz(?:en|e|t)"
    r"|(?:inter)?cambi(?:ar|e|en|ad)|reempla(?:zar|ce|cen)|sustitu(?:ir|ya|yan)|corr(?:egir|ija|ijan)"
    r"|añad(?:ir|a|an)|agreg(?:ar|ue|uen)|inviert[ea]n?|invertir|multipli(?:car|que|quen)|pon(?:er|ga|gan)"
    r"|us(?:ar|e|en)|le(?:er|an?)|tom(?:ar|e|en)"
    r"|échange[rz]|inverse[rz]|permute[rz]|remplace[rz]|change[rz]|modifie[rz]|corrige[rz]|ajoute[rz]"
    r"|li(?:re|sez)|mett(?:re|ez)|pren(?:dre|ez)|multiplie[rz]|utilise[rz]",
    rf"{_DROP_IN_CHINESE}|改[成为正]|修[改正]|更正|[替更]?换[成为]?|加上|乘以?|取反|反号|变号|移到|当作|看作|算作|交换|互换|对调",
)
_PLEASE: Final = _words(
    r"please|pls|kindly|bitte|por\sfavor|svp|s['’]il\s(?:vous|te)\spla[iî]t|merci\sde|veuillez|prière\sde",
    "请|麻烦",
)
# Words before the verb of a request.
_OPENING: Final = regex(
    r"[\W_\d]{0,9}(?:(?:please|pls|kindly|p\.\s?s\.?|so|and|but|then|also|just|note|important|hint|à|to|zu)"
    r"[\s:,.]{1,3}){0,3}",
    re.IGNORECASE,
)

# A remark on a cell is short: "?", "zero!", "not 180", "doch 0".
_DOUBTS_CELL: Final = regex(r"[?？¿]")
_GIVES_CELL: Final = regex(
    rf"\W{{0,5}}(?:(?:not|no|nicht|pas|doch|eher|besser|lieber|rather|better|now|jetzt|plutôt|mejor|ahora|要|改)"
    rf"\s?)(?:{_VALUE}).{{0,9}}|\W{{0,5}}(?:zero|null|cero|zéro|negativ\w?|négati\w{{1,2}}|minus|menos|moins)\W{{0,5}}",
    re.IGNORECASE,
)
# "0, not 180".
_NOT_THIS: Final = regex(
    rf"{_VALUE}\S?,?\s?(?:(?:und|and|y|et)\s)?(?:not|no|nicht|pas|non|不是)\s?{_VALUE}",
    re.IGNORECASE,
)
# The number of a joint is no value.
_PLACE_NUMBER: Final = regex(
    rf"(?<![^\W_])(?:{_LINES}|{_LINKS}|{_ORDINAL})\s?(?:{_NUMBER})?|[xyz]_?\{{?\d"
    r"|(?:fig|figure|abb)\w{0,6}\.?\s?\d",
    re.IGNORECASE,
)


# --- What is said about the whole answer


_WITHDRAWN: Final = _words(
    r"(?<!i\s)(?<!we\s)(?:do\snot|don['’]?t|please\snot|not\sto)\s(?:\w{1,12}\s){0,2}?"
    r"(?:grade|mark|count|assess|evaluate|score|consider|use|look\sat|check)"
    rf"|{_NOT}\s(?:to\s)?be\s(?:graded|marked|counted|assessed|evaluated|scored|considered|used)"
    r"|not\s(?:\w{1,12}\s){0,2}for\sgrading"
    rf"|{_NOT}\s(?:\w{{1,12}}\s){{0,2}}(?:final|finished|complete|completed|ready)"
    r"|incomplet[eo]?|unvollständig\w{0,2}|rest\s(?:folgt|kommt|follows)|work\sin\sprogress|placeholder|unfinished|preliminary"
    r"|(?:only|just|a|still\sa)\s(?:rough\s|first\s)?draft\Z|(?:only|just|is|still)\s(?:a\s)?draft"
    r"|nicht\s(?:\w{1,12}\s){0,2}?(?:be)?(?:werten|wertet|noten|achten|rücksichtigen|zählen)"
    r"|nicht\s(?:\w{1,12}\s){0,2}?(?:korrigieren|verwenden)|ungewertet"
    r"|(?:nur|noch|bloß)\s(?:\w{1,4}\s)?(?:erster?\s)?entwurf|unfertig\w{0,2}|vorläufig\w{0,2}"
    r"|nicht\s(?:\w{1,12}\s){0,2}?(?:fertig|final|endgültig)\w{0,2}|platzhalter"
    r"|no\ses\s(?:\w{1,9}\s){0,2}?(?:final|definitiv[ao])|pas\s(?:\w{1,9}\s){0,2}?(?:finale?|définiti\w{1,2})"
    r"|no\s(?:\w{1,12}\s){0,2}?(?:califi(?:que|quen|car)|eval(?:úe|úen|uar)|corr(?:ija|ijan|egir)"
    r"|consider(?:e|en|ar)|c(?:uente|uenten|ontar)|punt(?:úe|úen|uar)|ten(?:er|ga|gan)\sen\scuenta"
    r"|us(?:e|en)|tom(?:e|en))|(?:no|sin)\s(?:\w{1,5}\s)?(?:terminad[oa]|terminar|acabad[oa])|borrador|provisional|preliminar"
    r"|ne\spas\s(?:\w{1,12}\s){0,2}?(?:noter|corriger|compter|évaluer|prendre|tenir|utiliser)"
    r"|ne\s(?:l[ae]s?\s)?(?:notez|corrigez|comptez|évaluez|tenez|prenez|utilisez)\spas|brouillon"
    r"|provisoire|inachevé\w{0,2}|pas\s(?:encore\s)?(?:fini|terminé)\w{0,2}"
    r"|nothing\s(?:of|in)\sthis\scounts|obsolete|outdated|superseded|veraltet\w{0,2}|überholt|obsolet\w{0,2}",
    r"(?:不要|勿|别|不用|不必|无需|不)\s?(?:给分|评分|批改|打分|计分|计入|看这|算)|草稿|初稿|没?未?完成版|[没未](?:有)?[写做]?完[成]?",
)
_ELSEWHERE: Final = _words(
    r"(?:right|correct|real|actual|final|valid|proper|corrected|new|updated)\s(?:one|table|version"
    r"|answers?|solution|file|values?)\s(?:is|are|will|can|follows?|comes?|on|in|below|attached|sent)"
    r"|(?:richtige|korrekte|endgültige|eigentliche|finale|gültige|korrigierte|neue)[nr]?\s(?:tabelle"
    r"|version|lösung|antwort|datei|fassung|werte)\s(?:ist|sind|steht|stehen|liegt|kommt|folgt|findet"
    r"|finden|auf|per|im?n?|wird)"
    r"|(?:tabla|versión|respuesta|solución|archivo)\s(?:correct[ao]|buen[ao]|final|definitiv[ao]|real)"
    r"\s(?:está|viene|va|se|en|la|lo|es|llega\w{0,2})"
    r"|(?:bon(?:ne)?|vrai[e]?|nouve(?:au|lle))\s(?:table(?:au)?|version|réponse|solution|fichier)\s(?:est"
    r"|sera|suit|arrive|se)|(?:version|réponse|solution|tableau)\s(?:correcte?|finale?|définitive?|just"
    r"e|corrigée?)\s(?:est|sera|suit|suivra|arrive|se)"
    r"|(?:see|use|grade|take|look\sat|siehe|nehmen|verwenden|ver|usar|usen|voir|utilise[rz])\s"
    r"(?:instead\s)?(?:\w{1,12}\s){0,5}?(?:photo|scan|paper|handwritten|other\sfile|foto|papier|papel"
    r"|andere\s?[nr]?\sdatei|otro\sarchivo|autre\sfichier)|by\shand\son|handschriftlich\w{0,2}\skorr\w{1,9}"
    r"|wrong\s(?:file|upload|version|sheet)|falsche[ns]?\s(?:datei|version|blatt|tabelle)"
    r"|archivo\sequivocado|mauvais\s(?:fichier|tableau)|mauvaise\s(?:version|table|feuille)",
    r"(?:正确|最终|正式|新|修改后|真正)的?(?:答案|表格?|版本|文件)\s?(?:是|在|见|会|将|稍后|以)|以.{1,10}为准|传错|交错|上传错|发错",
)
_ANNOUNCED: Final = regex(
    r"[\W_]{0,9}(?:corrections?|corrigend(?:um|a)|errat(?:um|a)|korrektur(?:en)?|berichtigung"
    r"|correcci[oó]n(?:es)?|rectificaci[oó]n|rectification|更正|勘误|订正)"
    r"(?:[ \t]{0,3}[:：.!,]|\s(?:to|in|for|zu|zur|in|a|de|à|pour|of)\s(?:\w{1,5}\s)?"
    rf"(?:{_LINES}|{_LINKS}|{_LETTER}_?\d))",
    re.IGNORECASE,
)
_ADDED: Final = regex(
    r"[\W_]{0,9}(?:update|edit|nachtrag|addendum|actualizaci[oó]n|mise\sà\sjour|p\.?\s?s\.?|补充|修改|ps)"
    r"[ \t]{0,3}[:：.!,]",
    re.IGNORECASE,
)

# --- What takes such words back


# "If anything is wrong, please write to me", "I hope there are no mistakes".
_SUPPOSED: Final = _words(
    r"if|in\scase|whether|unless|hope(?:fully)?|falls|wenn|ob|hoffe(?:ntlich|n)?|si|espero|ojalá"
    r"|espère|espérons|any\s(?:mistake|error|typo)s?|avoid|vermeid\w{2,3}|evitar|éviter"
    r"|(?:no|not\sany|without|zero|keine?n?|ohne|sin|ning[uú]n\w{0,1}|aucune?|sans|pas\sd['’e])\s?"
    r"(?:\w{1,12}\s){0,1}(?:mistakes?|errors?|typos?|fehler|errores|error|erreurs?|fautes?|problems?)",
    "如果|若|是否|希望|如有|没有?错|无误|有没有|避免",
)
# "I corrected the mistake in row 2", "My first upload was wrong".
_PAST: Final = _words(
    r"(?:first|previous|earlier|old|last)\s(?:upload|file|version|attempt|submission|try|table)"
    r"|(?:erste[nrs]?|vorherige[nrs]?|frühere[nrs]?|alte[nrs]?)\s(?:abgabe|datei|version|versuch|tabelle)"
    r"|(?:primer[ao]?|anterior)\s(?:entrega|archivo|versión|intento)|(?:entrega|versión|tabla)\santerior"
    r"|premi(?:er|ère)\s(?:envoi|rendu|version|fichier|essai)|version\sprécédente"
    r"|(?:have|has|is|are|was|were|been|now|already|i|we)\s(?:now\s|already\s|been\s)?(?:corrected|fixed"
    r"|solved|resolved)|(?:korrigiert|behoben|verbessert|berichtigt)[.!]?\Z|(?:habe|wurde|bereits|schon)\s"
    r"(?:\w{1,12}\s){0,6}(?:korrigiert|behoben|verbessert|berichtigt)|(?:he|ya|está|fue)\s(?:\w{1,4}\s)?"
    r"corregid[oa]|corregí|(?:ai|est|été|déjà)\scorrigée?s?",
    "(?:已经?|都)(?:改|修改|更正|订正|修正)|(?:改|修正|更正)(?:好|过)了|(?:第一次|上次|之前|上一版)",
)
# An explanation of the frames.
_REASON: Final = _words(
    r"because|since|as|so\s(?:that)?|therefore|hence|thus|due\sto|weil|da|denn|daher|deshalb|also|damit"
    r"|porque|ya\sque|puesto\sque|por\s(?:eso|lo)|pues|car|parce\sque?|puisque|donc|ainsi",
    "因为|由于|所以|因此|故",
)

# --- Whether a sentence may change a table


# What an explanation of the frames does not name.
_SIGN: Final = _words(
    r"signs?|vorzeichen|signos?|signes?|order|reihenfolge|orden|ordre|values?|werte?"
    rf"|{_LINES}",
    "符号|正负号|顺序",
)
# A longer sentence is judged in pieces, which overlap.
_LONGEST: Final = 600
_OVERLAP: Final = 200


def may_change(sentence: str, *, of_cell: bool = False) -> bool:
    """True if a sentence may change the meaning of a table beside it.

    With ``of_cell``, the sentence is a remark on a cell or row: its place is known.
    """
    text = " ".join(sentence.split())
    starts = range(0, max(len(text) - _OVERLAP, 1), _LONGEST - _OVERLAP)
    return any(_piece_may_change(text[i : i + _LONGEST], of_cell=of_cell) for i in starts)


@lru_cache(maxsize=1024)
def _piece_may_change(text: str, *, of_cell: bool) -> bool:
    checkpoint()
    if _ANNOUNCED.match(text) or _WITHDRAWN.search(text):
        return True
    if _ELSEWHERE.search(text) and not _PAST.search(text):
        return True
    in_cell = of_cell or bool(_CELL.search(text))
    is_placed = in_cell or bool(_LINK.search(text) or _PROPERTY.search(text))
    if not is_placed and not _TABLE.search(text):
        return False
    checkpoint()
    if _is_request(text, in_cell=in_cell):
        return True
    if is_placed and (_gives_other(text, in_cell=in_cell) or (of_cell and _of_cell(text))):
        return True
    if _SUPPOSED.search(text) or _PAST.search(text):
        return False
    if _WRONG.search(text):
        return True
    if not is_placed or (_REASON.search(text) and not of_cell):
        # An explanation such as "α₂ is 180° because z₂ is reversed".
        return False
    if _TURNED.search(text):
        return in_cell or bool(_SIGN.search(text))
    return bool(_DOUBTFUL.search(text))


def _gives_other(text: str, *, in_cell: bool) -> bool:
    # A sentence about a place of the table that no "if" takes back.
    return bool(
        _ADDED.match(text)
        or _should_be(text, in_cell=in_cell)
        or _NOT_THIS.search(text)
        or _UNSURE.search(text)
    )


def _of_cell(text: str) -> bool:
    return bool(_DOUBTS_CELL.search(text) or _GIVES_CELL.fullmatch(text))


def _is_request(text: str, *, in_cell: bool) -> bool:
    opening = _OPENING.match(text)
    start = opening.end() if opening else 0
    is_polite = _PLEASE.search(text) is not None
    for found in _REQUEST.finditer(text):
        # A request begins with its verb, or a German one ends with it.
        is_at_end = text[found.end() :].strip(" .!") == ""
        if not (is_polite or found.start() <= start or is_at_end or found[0] > "\u2e80"):
            continue
        if in_cell or _SIGN.search(text) or (_DROPS.match(found[0]) and _TABLE.search(text)):
            return True
    return False


def _should_be(text: str, *, in_cell: bool) -> bool:
    plain = _PLACE_NUMBER.sub(" ", text)
    given = filter(None, (_GIVES.match(plain, found.end()) for found in _MODAL.finditer(plain)))
    # All lengths must be positive.
    return any(in_cell or not _POSITIVE.match(each["value"]) for each in given)


# --- The values that a sentence gives to cells


@dataclass(frozen=True, slots=True)
class Claim:
    """What a sentence says of a cell: its column, its row from 1 (or -1, the last), its value."""

    column: str
    row: int
    value: str


_COLUMNS: Final = {
    "a": r"a|link\slength|length|gliedlänge|longitud|longueur|连杆长度|长度|杆长",
    "alpha": (
        r"\\?alpha|\\?alfa|α|(?:link\s)?twist(?:\sangle)?|verdrehung|verwindung|torsi[oó]n|扭转?角"
    ),
    "d": r"d|(?:link|joint)?\s?offset|偏[距置移]|décalage",
    "theta": r"\\?theta|θ|joint\sangle|gelenkwinkel|关节角",
}
_PARAMETER: Final = "|".join(f"(?P<{name}>{words})" for name, words in _COLUMNS.items())
_IS: Final = (
    r"(?:\s?[=:：→≔]|\s?[-=]>|\s(?:is|are|was|equals|becomes|ist|sind|war|beträgt"
    r"|mit|with(?:\sa)?|con|avec(?:\sun)?|es|son|est|vale|vaut)"
    r"(?![^\W_])|\s?(?:等于|应?为|是|变成))"
)
_GIVEN: Final = (
    r"[-+−–]?\s?(?:\d{1,6}(?:[.,]\d{1,6})?\s?(?:\*?\s?(?:π|pi))?|π|pi)(?:\s?/\s?\d)?"
    r"(?:\s?(?:°|deg\w{0,4}|grad\w{0,2}|rad\w{0,4}|度))?"
    r"|zero|null|cero|zéro|零|minus|menos|moins|negativ\w?|négati\w{1,2}|positiv\w?"
    r"|positi\w{1,2}|负的?|正的?"
)
_INDEXED: Final = regex(
    rf"(?<![A-Za-z\d_])(?:{_PARAMETER})\s?_?\{{?(?P<row>\d)\}}?{_IS}\s?(?:[^\W\d]{{2,12}}\s){{0,2}}"
    rf"(?P<value>{_GIVEN})(?![\w*^(])",
    re.IGNORECASE,
)
_UNINDEXED: Final = regex(
    rf"(?<![A-Za-z\d_])(?:{_PARAMETER})(?![A-Za-z\d]|\s?_)(?:[^.;=:]{{0,40}}?){_IS}\s?"
    rf"(?:[^\W\d]{{2,12}}\s){{0,2}}(?P<value>{_GIVEN})(?![\w*^(])",
    re.IGNORECASE,
)
_ORDER: Final = (
    "first|1st|erst|primer|premi", "second|2nd|zweit|segund|deuxi",
    "third|3rd|dritt|tercer|troisi",
    "fourth|4th|viert|cuart|quatri", "fifth|5th|fünft|quint|cinqui", "sixth|6th|sechst|sext|sixi",
)  # fmt: skip
_ROW_NUMBER: Final = regex(
    rf"(?<![^\W_])(?:{_LINES}|{_LINKS})\s?(?:no\.?\s?)?(?P<number>\d)|(?:连杆|关节|杆件)\s?(?P<link>\d)"
    r"|第\s?(?P<chinese>[\d一二三四五六])\s?(?:行|个?连杆|个?关节)"
    r"|(?P<last>(?<![^\W_])(?:last|letzt|[uú]ltim|derni)|最后一行)|"
    + "|".join(rf"(?P<order{i}>(?<![^\W_])(?:{words}))" for i, words in enumerate(_ORDER, 1)),
    re.IGNORECASE,
)

_LOWERED: Final = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
_NEGATIVE: Final = regex("neg|nég|负|minus|menos|moins", re.IGNORECASE)
_POSITIVE: Final = regex("pos|正", re.IGNORECASE)
_ZERO: Final = regex("zero|null|cero|zéro|零", re.IGNORECASE)
_FRACTION: Final = regex(
    r"([-+−–]?)\s?(\d{1,9}(?:[.,]\d{1,9})?)?\s?\*?\s?(π|\\?pi)?(?:\s?/\s?(\d{1,3}))?\s?(?:°|deg\w*|grad\w*|rad\w*|度)?",
    re.IGNORECASE,
)


def claims(sentence: str) -> Iterator[Claim]:
    """Yield the values that a sentence gives to cells of a table: "α₂ = 0", "in row 2, a is 0"."""
    text = " ".join(sentence[:_LONGEST].translate(_LOWERED).split())
    for found in _INDEXED.finditer(text):
        yield Claim(_column(found), int(found["row"]), found["value"])
    rows = {_row(found) for found in _ROW_NUMBER.finditer(text)}
    if len(rows) == 1:
        [row] = rows
        for found in _UNINDEXED.finditer(text):
            yield Claim(_column(found), row, found["value"])


def _column(found: re.Match[str]) -> str:
    return next(name for name in _COLUMNS if found[name])


def _row(found: re.Match[str]) -> int:
    if found["last"]:
        return -1
    if digit := found["number"] or found["link"] or found["chinese"]:
        return int(digit) if digit.isascii() else "一二三四五六".index(digit) + 1
    return next(i for i in range(1, len(_ORDER) + 1) if found[f"order{i}"])


def contradicts(value: str, cell: str) -> bool:
    """True if a value in a sentence is not the value of a cell.

    A cell with letters, such as θ₁ or l₁, has no number that could differ, but a sign.
    """
    is_negative = cell.strip(" $").startswith(("-", "−", "–"))
    if _NEGATIVE.match(value):
        return not is_negative
    if _POSITIVE.match(value):
        return is_negative
    said, written = _numbers(value), _numbers(cell)
    if not written:
        return False
    return not any(math.isclose(one, other, abs_tol=0.01) for one in said for other in written)


def _numbers(text: str) -> set[float]:
    # The number as it is and in degrees: nobody knows in which unit a sentence is.
    if _ZERO.fullmatch(text.strip()):
        return {0.0}
    found = _FRACTION.fullmatch(text.strip(" $"))
    if found is None or not (found[2] or found[3]):
        return set()
    number = float((found[2] or "1").replace(",", ".")) / float(found[4] or 1)
    number *= math.pi if found[3] else 1
    number *= 1 if found[1] in ("", "+") else -1
    return {number, math.radians(number), math.degrees(number)}
