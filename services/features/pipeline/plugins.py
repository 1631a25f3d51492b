"""Every plugin's name and class. Pure data: a class is imported when it is chosen, see `registry`."""

CLASSIC = {
    "sift": "services.features.extractors.sift:Sift",
    "orb": "services.features.extractors.orb:Orb",
    "beblid": "services.features.extractors.beblid:Beblid",
}
PATCH_NETWORKS = {
    "tfeat": "services.features.extractors.tfeat:TFeat",
    "hardnet": "services.features.extractors.hardnet:HardNet",
    "hardnet8": "services.features.extractors.hardnet8:HardNet8",
    "sosnet": "services.features.extractors.sosnet:SosNet",
    "mkd": "services.features.extractors.mkd:Mkd",
}
KEYPOINT_NETWORKS = {
    "aliked-t16": "services.features.extractors.aliked:Aliked",
    "aliked-n16": "services.features.extractors.aliked:Aliked",
    "aliked-n16rot": "services.features.extractors.aliked:Aliked",
    "aliked-n32": "services.features.extractors.aliked:Aliked",
    "disk": "services.features.extractors.disk:Disk",
    "xfeat": "services.features.extractors.xfeat:XFeat",
    "dedode": "services.features.extractors.dedode:DeDoDe",
    "superpoint": "services.features.extractors.superpoint:SuperPoint",
}
PLUGINS: dict[str, dict[str, str]] = {
    "extractor": CLASSIC | PATCH_NETWORKS | KEYPOINT_NETWORKS,
    "representation": {
        "equirectangular": "services.features.representations.equirectangular:Equirectangular",
        "tangent": "services.features.representations.tangent:Tangent",
        "planar": "services.features.representations.planar:Planar",
    },
    "matcher": {
        "mutual_ratio": "services.features.matchers.mutual_ratio:MutualRatio",
        "brute_force": "services.features.matchers.brute_force:BruteForce",
        "lightglue": "services.features.matchers.lightglue:LightGlue",
        "superglue": "services.features.matchers.superglue:SuperGlue",
        "superglue-outdoor": "services.features.matchers.superglue:SuperGlue",
    },
}
