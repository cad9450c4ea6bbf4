"use strict";(()=>{var re,uu,ji,Fn,Gi,ul,cu,sl,fu,qi,Bi,Vd,vr=Symbol.for("pv"),cl={},fl=[],zd=/^m(i|n|o|s|text|space)$/,Yi=Array.isArray,Ki=fl.
slice,Zn=Object.assign;function Kn(e){e&&e.parentNode&&e.remove()}function pu(e,t,n){var o,r,l,a={},c=arguments.length;for(l in t)
l=="key"?o=t[l]:l=="ref"&&typeof e!="function"?r=t[l]:a[l]=t[l];return c>2&&(a.children=c>3?Ki.call(arguments,2):n),gr(e,
a,o,r,null)}function gr(e,t,n,o,r){var l={type:e,props:t,key:n,ref:o,__k:null,__:null,__b:0,__e:null,__c:null,constructor:vr,__v:r||
++uu,__i:-1,__u:0};return!r&&re.vnode&&re.vnode(l),l}function te(e){return e.children}function Do(e,t){this.props=e,this.context=t,this.__g=0}function Cn(e,t){if(t==null)return e.
__&&Cn(e.__,e.__i+1);for(var n;t<e.__k.length;t++)if((n=e.__k[t])&&n.__e)return n.__e;return typeof e.type!="function"||
e.props.__P?null:Cn(e)}function Hd(e){var t,n=e.__v,o=n.__e,r=[],l=[],a=e.__P;a&&((t=Zn({constructor:vr},n)).__v=n.__v+1,
re.vnode&&re.vnode(t),Zi(a,t,n,e.__n,a.namespaceURI,32&n.__u?[o]:null,r,o||Cn(n),32&n.__u,l),t.__v=n.__v,t.__.__k[t.__i]=
t,_u(r,t,l),n.__=n.__e=null,t.__e!=o&&du(t))}function du(e){if((e=e.__)&&e.__c&&!e.props.__P)return e.__e=null,e.__k.some(
function(t){return t&&(e.__e=t.__e)}),du(e)}function su(e){(8&e.__g||(e.__g|=8,Fn.push(e),ul++))&&Gi==re.debounceRendering||
((Gi=re.debounceRendering)||queueMicrotask)(mu)}function mu(){try{for(var e,t=1;Fn.length;)Fn.length>t&&Fn.sort(cu),e=Fn.
shift(),t=Fn.length,8&e.__g&&Hd(e)}finally{(ul=Fn.length)&&(Gi||queueMicrotask)(mu)}}function hu(e,t,n,o,r,l,a,c,d,m,g){
var _,x,v,k,N,E,F=o.__k||fl,w=t.length;for(d=Ud(n,t,F,d,w),_=0;_<w;_++)(v=n.__k[_])!=null&&(x=~v.__i&&F[v.__i]||cl,v.__i=
_,E=Zi(e,v,x,r,l,a,c,d,m,g),k=v.__e,(x.ref!=v.ref||8&x.__u)&&(x.ref&&Ji(x.ref,null,v,x),v.ref&&g.push(v.ref,v.__c||k,v)),
N=N||k,4&v.__u?(d=gu(v,d,e,!x.__v),x.__e&&(x.__e=null)):typeof v.type=="function"&&E!==void 0?d=E:k&&(d=k.nextSibling),v.
__u&=-21);return n.__e=N,d}function Ud(e,t,n,o,r){var l,a,c,d,m,g,_,x,v,k=n.length,N=k,E=0,F=0,w=e.__k=Array(r);for(l=0;l<
r;l++)(a=t[l])!=null&&typeof a!="boolean"&&typeof a!="function"?(typeof a!="object"||a.constructor===String?a=w[l]=gr(null,
a):Yi(a)?a=w[l]=gr(te,{children:a}):a.constructor===vr&&a.__b?a=w[l]=gr(a.type,a.props,a.key,a.ref,a.__v):w[l]=a,d=l+E,a.
__=e,a.__b=e.__b+1,c=null,~(m=a.__i=Wd(a,n,d,N))&&(N--,(c=n[m])&&(c.__u|=2)),c&&c.__v?(a.__u|=16,m==d-1?E--:m==d+1?E++:m!=
d&&(m>d?E--:E++,F=1)):(~m||(r>k?E--:r<k&&E++),typeof a.type!="function"&&(a.__u|=4))):w[l]=null;if(F){for(g=[],_=[],l=0;l<
r;l++)if((a=w[l])&&16&a.__u){for(E=0,x=g.length;E<x;)g[v=E+x>>1]<a.__i?E=v+1:x=v;g[E]=a.__i,_[l]=E+1}for(E=g.length;l--;)
_[l]&&(_[l]==E?E--:w[l].__u|=4)}if(N)for(l=0;l<k;l++)!(c=n[l])||2&c.__u||(c.__e==o&&(o=Cn(c)),Xi(c,c));return o}function gu(e,t,n,o){
var r,l,a,c;if(typeof e.type=="function"){if(e.props.__P)return t;if(r=e.__k)for(l=0;l<r.length;l++)r[l]&&(r[l].__=e,t=gu(
r[l],t,n,!1));return t}for(t&&!t.parentNode&&(t=Cn(e))&&!t.parentNode&&(t=null),a=e.__e,c=t;c&&c.nodeType==8;)c=c.nextSibling;
for(a!=c&&(!o&&n.moveBefore&&a.parentNode?n.moveBefore(a,t):n.insertBefore(a,t||null)),t=a;(t=t&&t.nextSibling)&&t.nodeType==
8&&!t.data.startsWith("$s"););return t}function Wd(e,t,n,o){var r,l=e.key,a=e.type,c=t[n],d=c&&!(2&c.__u);if(c===null&&l==null||d&&l==c.key&&a==c.type)return n;
if(o>(d?1:0)){for(r=n-1;r>=0;r--)if((c=t[r])&&!(2&c.__u)&&l==c.key&&a==c.type)return r;for(r=n+1;r<t.length;r++)if((c=t[r])&&
!(2&c.__u)&&l==c.key&&a==c.type)return r}return-1}function au(e,t,n){n==null&&(n=""),t[0]=="-"?e.setProperty(t,n):e[t]=n}
function il(e,t,n,o,r){var l,a;if(t=="style")if(typeof n=="string")e.style.cssText=n;else{if(typeof o=="string"&&(e.style.
cssText=o=""),o)for(t in o)n&&t in n||au(e.style,t);if(n)for(t in n)o&&n[t]==o[t]||au(e.style,t,n[t])}else if(t[0]=="o"&&
t[1]=="n")typeof n!="function"&&(n=null),typeof o!="function"&&(o=null),(e.__e||(e.__e={}))[t]=n,n&&o||(a=Bi[t]||(Bi[t]=
Gd(t)),(e.__a||(e.__a={}))[t]=qi,l=t!=(t=t.replace(fu,"$1")),(t=t.slice(2))[0]<"a"&&(t=t.toLowerCase()),n?e.addEventListener(
t,a,l):e.removeEventListener(t,a,l));else{if(r=="http://www.w3.org/2000/svg")t=t.replace(/xlink(H|:h)/,"h").replace(/sName$/,
"s");else if(t!="width"&&t!="height"&&t!="href"&&t!="list"&&t!="form"&&t!="tabIndex"&&t!="download"&&t!="rowSpan"&&t!="c\
olSpan"&&t!="role"&&t!="popover"&&t in e)try{return void(e[t]=n??"")}catch{}if(typeof n=="function")return;n==null||n===
!1&&t[4]!="-"?e.removeAttribute(t):e.setAttribute(t,t=="popover"&&n==1?"":n)}}function Gd(e){return function(t){var n=this.
__e;if(n){if(n=n[e],t[sl]==null)t[sl]=qi++;else if(t[sl]<this.__a[e])return;return n(re.event?re.event(t):t)}}}function Zi(e,t,n,o,r,l,a,c,d,m){
var g,_,x,v,k,N,E,F,w,P,S,K,L,Z,G,X,W,A,B=t.type;if(t.constructor!==vr)return null;128&n.__u&&(d=32&n.__u,g=n.__c.__z)&&
(t.__u|=d,_=l=[],g.nodeType==8?c=al(g,l):l.push(g),c=l[0]||c),(g=re.__b)&&g(t);e:if(typeof B=="function"){x=a.length;try{
if(F=t.props,w=(g=B.prototype)&&g.render,P=(g=B.contextType)&&o[g.__c],S=g?P?P.props.value:g.__:o,(v=n.__c)?(t.__c=v,2&v.
__g&&(v.__g|=1)):(w?t.__c=v=new B(F,S):(t.__c=v=new Do(F,S),v.constructor=B,v.render=jd),P&&P.sub(v),v.state||(v.state={}),
v.__n=o,v.__g|=8,v.__h=[],v.__k=[]),w&&(v.__s||(v.__s=v.state),B.getDerivedStateFromProps&&(v.__s==v.state&&(v.__s=Zn({},
v.__s)),Zn(v.__s,B.getDerivedStateFromProps(F,v.__s)))),k=v.props,N=v.state,v.__v=t,n.__c){if(F!==k&&w&&!B.getDerivedStateFromProps&&
v.componentWillReceiveProps&&v.componentWillReceiveProps(F,S),t.__v==n.__v&&!(8&v.__g)||!(4&v.__g)&&v.shouldComponentUpdate&&
v.shouldComponentUpdate(F,v.__s,S)===!1){t.__v!=n.__v&&(v.props=F,v.state=v.__s,v.__g&=-9),t.__e=n.__e,t.__k=n.__k,t.__k.
some(function(C){C&&(C.__=t)}),fl.push.apply(v.__h,v.__k),v.__k=[],v.__h.length&&a.push(v),c=Cn(n);break e}v.componentWillUpdate&&
v.componentWillUpdate(F,v.__s,S),w&&v.componentDidUpdate&&v.__h.push(function(){v.componentDidUpdate(k,N,E)})}else w&&!B.
getDerivedStateFromProps&&v.componentWillMount&&v.componentWillMount(),w&&v.componentDidMount&&v.__h.push(v.componentDidMount);
v.context=S,v.props=F,v.__P=e,v.__g&=-5,K=re.__r,L=w?25:0;do v.__g&=-9,K&&K(t),g=v.render(v.props,v.state=v.__s,v.context);while(8&
v.__g&&++L<25);w&&(fl.push.apply(v.__h,v.__k),v.__k=[]),v.state=v.__s,v.getChildContext&&(o=Zn({},o,v.getChildContext())),
w&&n.__c&&v.getSnapshotBeforeUpdate&&(E=v.getSnapshotBeforeUpdate(k,N)),Z=g&&g.type===te&&g.key==null?g.props.children:g,
F.__P&&(g=c,r=(e=F.__P).namespaceURI,d=l=null,n.props&&n.props.__P!=e&&(n.__k.some(function(C){C&&Xi(C,C)}),n.__k=null),
c=n.__k?Cn(n,0):null),c=hu(e,Yi(Z)?Z:[Z],t,n,o,r,l,a,c,d,m),F.__P&&(t.__e=null,c=g),t.__u&=-161,_&&_.some(Kn),v.__h.length&&
a.push(v),1&v.__g&&(v.__g&=-4)}catch(C){if(a.length=x,t.__v=null,d||l)if(C&&C.then){if(t.__u|=128|d,l){for(~(W=l.indexOf(
c||void 0))||(W=l.length);(A=l[W-1])&&A.nodeType==8;)W--;for(;W<l.length;W++)if(A=l[W])if(l[W]=null,G){if(A==X)break}else{
if(A.nodeType!=8)break;A.data.startsWith("$s")&&(X=al(G=A))}}if(!G){for(;c&&c.nodeType==8&&c.nextSibling;)c=c.nextSibling;
G=c}(g=al(G=t.__c.__z||(t.__c.__z=G)))?(t.__e=G,c=g):t.__e=c,c=c&&c.nextSibling}else l&&l.some(Kn);else t.__e=n.__e;t.__k||
(t.__k=n.__k||[]),C&&C.then||vu(t),re.__e(C,t,n)}}else c=t.__e=Bd(n.__e,t,n,o,r,l,a,d,m,e);return(g=re.diffed)&&g(t),c}function al(e,t){
if(e&&e.nodeType==8&&e.data.startsWith("$s"))for(var n=1;e=e.nextSibling;){if(e.nodeType==8){if(e.data.startsWith("$s"))
n++;else if(e.data.startsWith("/$s")&&!--n)return e}t&&t.push(e)}}function vu(e){e&&(e.__c&&(e.__c.__g|=4),e.__k&&e.__k.
some(vu))}function _u(e,t,n){for(var o=0;o<n.length;)Ji(n[o++],n[o++],n[o++]);re.__c&&re.__c(t,e),e.some(function(r){try{
e=r.__h,r.__h=[],e.some(function(l){l.call(r)})}catch(l){re.__e(l,r.__v)}})}function Bd(e,t,n,o,r,l,a,c,d,m){var g,_,x,v,
k,N,E,F,w=n.props||cl,P=t.props,S=t.type;if(S=="svg"?r="http://www.w3.org/2000/svg":S=="math"?r="http://www.w3.org/1998/\
Math/MathML":r||(r="http://www.w3.org/1999/xhtml"),l){for(g=0;g<l.length;g++)if((k=l[g])&&(S?k.localName==S:k.nodeType==
3)){e=k,l[g]=null;break}}if(!e){if(F=m.ownerDocument||document,!S)return F.createTextNode(P);e=F.createElementNS(r,S,P.is?
P:m),c&&(re.__m&&re.__m(t,l),c=!1),l=null}if(S){if(m=S=="template"&&e.content||e,l=S=="textarea"&&P.defaultValue!=null?null:
l&&Ki.call(m.childNodes),!c&&l)for(w={},g=0;g<e.attributes.length;g++)w[(k=e.attributes[g]).name]=k.value;for(g in w)k=w[g],
g=="dangerouslySetInnerHTML"?x=k:g=="children"||g in P||g=="value"&&"defaultValue"in P||g=="checked"&&"defaultChecked"in
P||il(e,g,null,k,r);for(g in P)k=P[g],g=="children"?v=k:g=="dangerouslySetInnerHTML"?_=k:g=="value"?N=k:g=="checked"?E=k:
c&&typeof k!="function"||w[g]===k||il(e,g,k,w[g],r);_?(c||x&&(_.__html==x.__html||_.__html==e.innerHTML)||(e.innerHTML=_.
__html),t.__k=[]):(x&&(e.textContent=""),(S=="foreignObject"||r=="http://www.w3.org/1998/Math/MathML"&&zd.test(S))&&(r="\
http://www.w3.org/1999/xhtml"),hu(m,Yi(v)?v:[v],t,n,o,r,l,a,l?l[0]:n.__k&&Cn(n,0),c,d),l&&l.some(Kn)),c&&S!="textarea"||
(g="value",S=="progress"&&N==null?e.removeAttribute(g):N==null||N===e[g]&&(S!="progress"||N)||il(e,g,N,w[g],r),g="checke\
d",E!=null&&E!=e[g]&&il(e,g,E,w[g],r))}else w===P||c&&e.data==P||(e.data=P);return e}function Ji(e,t,n,o){try{typeof e==
"function"?t?t.__x=e(t)||1:o&&(o=o.__c||o.__e)&&(t=o.__x)&&(o.__x=null,typeof t=="function"?t():e(null)):e.current=t}catch(r){
re.__e(r,n)}}function Xi(e,t,n){var o,r,l,a;if(re.unmount&&re.unmount(e),!(o=e.ref)||o.current&&o.current!=e.__e||Ji(o,null,
t,e),o=e.__c){if(o.componentWillUnmount)try{o.componentWillUnmount()}catch(c){re.__e(c,t)}o.__P=o.__n=null}if(o=e.__k)for(a=
0;a<o.length;a++)o[a]&&Xi(o[a],t,typeof e.type!="function"||n&&!e.props.__P);!n&&(o=e.__c)&&(o=o.__z)&&(r=al(o,l=[]))&&(o==
e.__e&&l.some(Kn),Kn(r),Kn(o)),n||Kn(e.__e),e.__e=e.__c=e.__=null}function jd(e,t,n){return this.constructor(e,n)}function bu(e,t){
var n,o,r,l;re.__&&re.__(e,t),t.nodeType==9&&(t=t.documentElement),o=(n=e&&32&e.__u)?null:t.__k,t.__k=gr(te,{children:[e]}),
r=[],l=[],Zi(t,t.__k,o||cl,cl,t.namespaceURI,o?null:t.firstChild?Ki.call(t.childNodes):null,r,o?o.__e:t.firstChild,n,l),
_u(r,t.__k,l),t.__k.props.children=null}re={__e:function(e,t,n,o){for(var r,l,a;t=t.__;)if((r=t.__c)&&!(1&r.__g)){r.__g|=4;try{if((a=(l=r.constructor)&&l.getDerivedStateFromError)&&
r.setState(l.getDerivedStateFromError(e)),r.componentDidCatch&&(r.componentDidCatch(e,o||{}),a=1),a&&8&r.__g)return void(r.
__g|=2)}catch(c){e=c}}throw ul=0,e}},uu=0,ji=function(e){return e!=null&&e.constructor===vr},Do.prototype.setState=function(e,t){
var n=this.__s;n&&n!=this.state||(n=this.__s=Zn({},this.state)),typeof e=="function"&&(e=e(Zn({},n),this.props)),e&&(Zn(
n,e),this.__v&&(t&&this.__k.push(t),su(this)))},Do.prototype.forceUpdate=function(e){this.__v&&(this.__g|=4,e&&this.__h.
push(e),su(this))},Do.prototype.render=te,Fn=[],ul=0,cu=function(e,t){return e.__v.__b-t.__v.__b},sl=Symbol(),fu=/(PointerCapture)$|Capture$/i,
qi=0,Bi={},Vd=0;var Lo,$e,Qi,xu,es=Object.is,pl=0,Nu=[],ts=[],Fe=re,wu=Fe.__b,yu=Fe.__r,Su=Fe.diffed,ku=Fe.__c,Mu=Fe.unmount,Tu=Fe.__;function dl(e,t){
Fe.__h&&Fe.__h($e,e,pl||t),pl=0;var n=$e.__H||($e.__H={__:[],__h:[]});return e>=n.__.length&&n.__.push({}),n.__[e]}function Pu(e){
return pl=1,qd(Ou,e)}function qd(e,t,n){var o=dl(Lo++,2);if(o.t=e,!o.__c&&(o.__=[n?n(t):Ou(void 0,t),function(l){var a=(o.
__N||o.__)[0],c=o.t(a,l);es(a,c)||(o.__N=[c,o.__[1]],o.__c.setState({}))}],o.__c=$e,!$e.__f)){$e.__f=!0;var r=$e.shouldComponentUpdate;
$e.shouldComponentUpdate=function(l,a,c){var d=this.__H;if(!d)return!0;var m=!1,g=this.props!=l;if(d.__.some(function(x){
x.__N&&(m=!0,es(x.__[0],x.__N[0])||(g=!0))}),r){var _=r.call(this,l,a,c);return m?_||g:_}return!m||g}}return o.__}function Qe(e,t){
var n=dl(Lo++,3);!Fe.__s&&os(n.__H,t)&&(n.__P=!0,n.__=e,n.u=t,$e.__H.__h.push(n))}function Ro(e,t){var n=dl(Lo++,4);!Fe.
__s&&os(n.__H,t)&&(n.__P=!1,n.__=e,n.u=t,$e.__h.push(n))}function Lt(e){return pl=5,ml(function(){return{current:e}},[])}function ml(e,t){var n=dl(Lo++,7);return os(n.__H,t)&&(n.__=e(),n.__H=t),n.__}function Yd(){var e;do{for(;e=ts.shift();)try{_r(e)}catch(n){Fe.__e(n,{__:(e=e.__P)&&e.__v})}for(;e=Nu.shift();){var t=e.
__H;if(e.__P&&t)try{t.__h.some(_r),t.__h.some(ns),t.__h=[]}catch(n){t.__h=[],Fe.__e(n,e.__v)}}}while(ts.length)}Fe.__b=function(e){
$e=null,wu&&wu(e)},Fe.__=function(e,t){e&&t.__k&&t.__k.__m&&(e.__m=t.__k.__m),Tu&&Tu(e,t)},Fe.__r=function(e){yu&&yu(e),
Lo=0;var t=($e=e.__c).__H;t&&(Qi==$e?$e.__h=[]:(t.__h.some(_r),t.__h.some(ns),Lo=0),t.__h=[],t.__.some(function(n){n.__N&&
(n.__=n.__N),n.u=n.__N=void 0})),Qi=$e},Fe.diffed=function(e){Su&&Su(e);var t=e.__c;t&&t.__H&&(t.__H.__h.length&&Eu(Nu.push(
t)),t.__H.__.some(function(n){n.u&&(n.__H=n.u)})),Qi=$e=null},Fe.__c=function(e,t){t.some(function(n){try{n.__h.some(_r),
n.__h=n.__h.filter(function(o){return!o.__||ns(o)})}catch(o){n.__h=[function(){throw o}]}}),ku&&ku(e,t)},Fe.unmount=function(e){
Mu&&Mu(e);var t,n,o=e.__c;o&&o.__H&&(o.__H.__.some(function(r){try{if(r.__P&&r.__c){if(n===void 0){for(n=e.__;n&&(!n.__c||
!n.__c.__P);)n=n.__;n=n&&n.__c}r.__P=n,Eu(ts.push(r))}else _r(r)}catch(l){t=l}}),o.__H=void 0,t&&Fe.__e(t,o.__v))};var Au=typeof requestAnimationFrame==
"function";function Kd(e){var t,n=function(){clearTimeout(o),Au&&cancelAnimationFrame(t),setTimeout(e)},o=setTimeout(n,35);
Au&&(t=requestAnimationFrame(n))}function Eu(e){e!=1&&xu==Fe.requestAnimationFrame||((xu=Fe.requestAnimationFrame)||Kd)(
Yd)}function _r(e){var t=$e,n=e.__c;typeof n=="function"&&(e.__c=void 0,n()),$e=t}function ns(e){var t=$e;e.__c=e.__(),$e=
t}function os(e,t){return!e||e.length!=t.length||t.some(function(n,o){return!es(n,e[o])})}function Ou(e,t){return typeof t==
"function"?t(e):t}var Zd=Symbol.for("preact-signals");function _l(){if(xn>1)xn--;else{var e,t=!1;for((function(){var r=gl;for(gl=void 0;r!==
void 0;){var l=r.S;if(l.v===r.v)for(var a=l.t;a!==void 0;a=a.x)a.i===r.i&&(a.i=l.i);r=r.o}})();xr!==void 0;){var n=xr;for(xr=
void 0,hl++;n!==void 0;){var o=n.u;if(n.u=void 0,n.f&=-3,!(8&n.f)&&Cu(n))try{n.c()}catch(r){t||(e=r,t=!0)}n=o}}if(hl=0,xn--,
t)throw e}}function un(e){if(xn>0)return e();rs=++Jd,xn++;try{return e()}finally{_l()}}var br,Ae=void 0;function wr(e){var t=Ae,
n=br;Ae=void 0,br=void 0;try{return e()}finally{Ae=t,br=n}}var xr=void 0,xn=0,hl=0,Jd=0,rs=0,gl=void 0,vl=0;function Fu(e){
if(Ae!==void 0){var t=e.n;if(t===void 0||t.t!==Ae)return t={i:0,S:e,p:Ae.s,n:void 0,t:Ae,e:void 0,x:void 0,r:t},Ae.s!==void 0&&
(Ae.s.n=t),Ae.s=t,e.n=t,32&Ae.f&&e.S(t),t;if(t.i===-1)return t.i=0,t.n!==void 0&&(t.n.p=t.p,t.p!==void 0&&(t.p.n=t.n),t.
p=Ae.s,t.n=void 0,Ae.s.n=t,Ae.s=t),t}}function Ve(e,t){this.v=e,this.i=0,this.n=void 0,this.t=void 0,this.l=0,this.W=t?.
watched,this.Z=t?.unwatched,this.name=t?.name}Ve.prototype.brand=Zd;Ve.prototype.h=function(){return!0};Ve.prototype.S=function(e){
var t=this,n=this.t;n!==e&&e.e===void 0&&(e.x=n,this.t=e,n!==void 0?n.e=e:wr(function(){var o;(o=t.W)==null||o.call(t)}))};
Ve.prototype.U=function(e){var t=this;if(this.t!==void 0){var n=e.e,o=e.x;n!==void 0&&(n.x=o,e.e=void 0),o!==void 0&&(o.
e=n,e.x=void 0),e===this.t&&(this.t=o,o===void 0&&wr(function(){var r;(r=t.Z)==null||r.call(t)}))}};Ve.prototype.subscribe=
function(e){var t=this;return ze(function(){var n=t.value;wr(function(){return e(n)})},{name:"sub"})};Ve.prototype.valueOf=
function(){return this.value};Ve.prototype.toString=function(){return this.value+""};Ve.prototype.toJSON=function(){return this.
value};Ve.prototype.peek=function(){var e=this;return wr(function(){return e.value})};Object.defineProperty(Ve.prototype,
"value",{get:function(){var e=Fu(this);return e!==void 0&&(e.i=this.i),this.v},set:function(e){if(e!==this.v){if(hl>100)
throw new Error("Cycle detected");(function(n){xn!==0&&hl===0&&n.l!==rs&&(n.l=rs,gl={S:n,v:n.v,i:n.i,o:gl})})(this),this.
v=e,this.i++,vl++,xn++;try{for(var t=this.t;t!==void 0;t=t.x)t.t.N()}finally{_l()}}}});function I(e,t){return new Ve(e,t)}
function Cu(e){for(var t=e.s;t!==void 0;t=t.n)if(t.S.i!==t.i||!t.S.h()||t.S.i!==t.i)return!0;return!1}function $u(e){for(var t=e.
s;t!==void 0;t=t.n){var n=t.S.n;if(n!==void 0&&(t.r=n),t.S.n=t,t.i=-1,t.n===void 0){e.s=t;break}}}function Du(e){for(var t=e.
s,n=void 0;t!==void 0;){var o=t.p;t.i===-1?(t.S.U(t),o!==void 0&&(o.n=t.n),t.n!==void 0&&(t.n.p=o)):n=t,t.S.n=t.r,t.r!==
void 0&&(t.r=void 0),t=o}e.s=n}function Jn(e,t){Ve.call(this,void 0,t),this.x=e,this.s=void 0,this.g=vl-1,this.f=4}Jn.prototype=
new Ve;Jn.prototype.h=function(){if(this.f&=-3,1&this.f)return!1;if((36&this.f)==32||(this.f&=-5,this.g===vl))return!0;if(this.
g=vl,this.f|=1,this.i>0&&!Cu(this))return this.f&=-2,!0;var e=Ae;try{$u(this),Ae=this;var t=this.x();(16&this.f||this.v!==
t||this.i===0)&&(this.v=t,this.f&=-17,this.i++)}catch(n){this.v=n,this.f|=16,this.i++}return Ae=e,Du(this),this.f&=-2,!0};
Jn.prototype.S=function(e){if(this.t===void 0){this.f|=36;for(var t=this.s;t!==void 0;t=t.n)t.S.S(t)}Ve.prototype.S.call(
this,e)};Jn.prototype.U=function(e){if(this.t!==void 0&&(Ve.prototype.U.call(this,e),this.t===void 0)){this.f&=-33;for(var t=this.
s;t!==void 0;t=t.n)t.S.U(t)}};Jn.prototype.N=function(){if(!(2&this.f)){this.f|=6;for(var e=this.t;e!==void 0;e=e.x)e.t.
N()}};Object.defineProperty(Jn.prototype,"value",{get:function(){if(1&this.f)throw new Error("Cycle detected");var e=Fu(
this);if(this.h(),e!==void 0&&(e.i=this.i),16&this.f)throw this.v;return this.v}});function St(e,t){return new Jn(e,t)}function Lu(e){
var t=e.j;if(e.j=void 0,typeof t=="function"){xn++;var n=Ae;Ae=void 0;try{t()}catch(o){throw e.f&=-2,e.f|=8,ls(e),o}finally{
Ae=n,_l()}}}function ls(e){for(var t=e.s;t!==void 0;t=t.n)t.S.U(t);e.x=void 0,e.s=void 0,Lu(e)}function Xd(e){if(Ae!==this)
throw new Error("Out-of-order effect");Du(this),Ae=e,this.f&=-2;try{8&this.f&&ls(this)}finally{_l()}}function Io(e,t){this.
x=e,this.j=void 0,this.s=void 0,this.u=void 0,this.f=32,this.name=t?.name,br&&br.push(this)}Io.prototype.c=function(){var e=this.
S();try{if(8&this.f||this.x===void 0)return;var t=this.x();typeof t=="function"&&(this.j=t)}finally{e()}};Io.prototype.S=
function(){if(1&this.f)throw new Error("Cycle detected");this.f|=1,this.f&=-9,Lu(this),$u(this),xn++;var e=Ae;return Ae=
this,Xd.bind(this,e)};Io.prototype.N=function(){2&this.f||(this.f|=2,this.u=xr,xr=this)};Io.prototype.d=function(){this.
f|=8,1&this.f||ls(this)};Io.prototype.dispose=function(){this.d()};function ze(e,t){var n=new Io(e,t);try{n.c()}catch(r){
throw n.d(),r}var o=n.d.bind(n);return o[Symbol.dispose]=o,o}var Ru,xl,bl,Qd=typeof window<"u"&&!!window.__PREACT_SIGNALS_DEVTOOLS__;var Iu=[];ze(function(){Ru=this.N})();function Vo(e,t){re[e]=t.bind(null,re[e]||function(){})}function yr(e){if(bl){var t=bl;
bl=void 0,t()}bl=e&&e.S()}function Vu(e){var t=this,n=e.data,o=tm(n);o.name="ReactiveDom",o.value=n;var r=ml(function(){
for(var c=t,d=t.__v;d=d.__;)if(d.__c){d.__c.__$f|=4;break}var m=St(function(){var v=o.value.value;return v===0?0:v===!0?
"":v||""}),g=St(function(){return!Array.isArray(m.value)&&!ji(m.value)}),_=ze(function(){if(this.N=zu,g.value){var v=m.value;
c.__v&&c.__v.__e&&c.__v.__e.nodeType===3&&(c.__v.__e.data=v)}}),x=t.__$u.d;return t.__$u.d=function(){_(),x.call(this)},
[g,m]},[]),l=r[0],a=r[1];return l.value?a.peek():a.value}Vu.displayName="ReactiveTextNode";Object.defineProperties(Ve.prototype,
{constructor:{configurable:!0,value:pu(te,null).constructor},type:{configurable:!0,value:Vu},props:{configurable:!0,get:function(){
var e=this;return{data:{get value(){return e.value}}}}},__b:{configurable:!0,value:1}});Vo("__b",function(e,t){if(yr(),xl=
void 0,typeof t.type=="string"){var n,o=t.props;for(var r in o)if(r!=="children"){var l=o[r];l instanceof Ve&&(n||(t.__np=
n={}),n[r]=l,o[r]=l.peek())}}e(t)});Vo("__r",function(e,t){if(e(t),t.type!==te){yr();var n,o=t.__c;o&&(o.__$f&=-2,(n=o.__$u)===
void 0&&(o.__$u=n=(function(r,l){var a;return ze(function(){a=this},{name:l}),a.c=r,a})((function(r){return function(){var l;
Qd&&((l=this.y)==null||l.call(this)),r.__$f|=1,r.setState({})}})(o),typeof t.type=="function"?t.type.displayName||t.type.
name:""))),xl=o,yr(n)}});Vo("__e",function(e,t,n,o){yr(),xl=void 0,e(t,n,o)});Vo("diffed",function(e,t){yr(),xl=void 0;var n;
if(typeof t.type=="string"&&(n=t.__e)){var o=t.__np,r=t.props,l=n.U;if(l)for(var a in l){var c=l[a];c===void 0||o&&a in o||
(c.d(),l[a]=void 0)}if(o){l||(l={},n.U=l);for(var d in o){var m=l[d],g=o[d];m===void 0?(m=em(n,d,g,r),l[d]=m):m.o(g,r)}}}
e(t)});function em(e,t,n,o){var r=t in e&&e.ownerSVGElement===void 0,l=I(n);return{o:function(a,c){l.value=a,o=c},d:ze(function(){
this.N=zu;var a=l.value.value;o[t]!==a&&(o[t]=a,r?e[t]=a:a!=null&&(a!==!1||t[4]==="-")?e.setAttribute(t,a):e.removeAttribute(
t))})}}Vo("unmount",function(e,t){if(typeof t.type=="string"){var n=t.__e;if(n){var o=n.U;if(o){n.U=void 0;for(var r in o){
var l=o[r];l&&l.d()}}}var a=t.__np;if(a){var c=t.props;for(var d in a)c[d]=a[d]}t.__np=void 0}else{var m=t.__c;if(m){m.__$f|=
8;var g=m.__$u;g&&(m.__$u=void 0,g.d())}}e(t)});Vo("__h",function(e,t,n,o){o<3&&(t.__$f|=2),e(t,n,o)});Do.prototype.shouldComponentUpdate=
function(e,t){if(this.__R)return!0;var n=this.__$u,o=n&&n.s!==void 0;for(var r in t)return!0;if(this.__f||typeof this.u==
"boolean"&&this.u===!0){var l=2&this.__$f;if(!(o||l||4&this.__$f)||1&this.__$f)return!0}else if(!(o||4&this.__$f)||3&this.
__$f)return!0;for(var a in e)if(a!=="__source"&&e[a]!==this.props[a])return!0;for(var c in this.props)if(!(c in e))return!0;
return!1};function tm(e,t){return ml(function(){return I(e,t)},[])}var nm=function(e){queueMicrotask(function(){queueMicrotask(e)})};function om(){un(function(){for(var e;e=Iu.shift();)Ru.call(e)})}function zu(){Iu.push(this)===1&&(re.requestAnimationFrame||
nm)(om)}var rm=95,is=new Set,ss=!1,Hu=0;function Uu(e){if(e-Hu<rm){requestAnimationFrame(Uu);return}ss=!1,Hu=e;let t=[...is];is.
clear(),un(()=>t.forEach(n=>{n.value+=1}))}function kt(e){is.add(e),!ss&&(ss=!0,requestAnimationFrame(Uu))}var Wu={int8:1,uint8:1,int16:2,uint16:2,int32:4,uint32:4,int64:8,uint64:8,float32:4,float64:8,string:4},Gu=e=>Wu[e],lm=/^# MAVLink (\S+) \((\d+)\)/,
im=/^(\w+) (\w+)=(-?\d+)$/,sm=/^(\w+?)(?:\[(\d+)\])? (\w+)(?:\s*#(?: \[(.*?)\])?(?: invalid: (\S+))?)?$/;function am(e){
let t=e.filter(n=>n!==0);return t.length>1&&Math.max(...t)>2&&t.every(n=>Number.isInteger(Math.log2(n)))}function um(e,t,n){
let o=`${t.toUpperCase()}_`,r=e.slice(o.length);return e.startsWith(o)&&n.has(r)?r:e}function cm(e,t,n){if(t.length===0)
return null;let o=new Map(t.map(([r,l])=>[l,um(r,e,n)]));for(let[r]of t)n.add(r);return o}function fm(e,t,n){let[,o="",r,
l="",a="",c=""]=e;if(!(o in Wu))throw new Error(`the schema has a type that MAVLink does not have: ${o}`);let d=cm(l,t,n);
return{name:l,type:o,length:r===void 0?null:Number(r),unit:a,invalid:c,entries:d,isFlags:d!==null&&am([...d.keys()])}}function Bu(e){
let t=e.split(`
`).map(a=>a.trim()).filter(a=>a!==""),n=t[0]?.match(lm),o=[],r=new Set,l=[];for(let a of t){let c=a.match(im);c&&l.push(
[c[2]??"",Number(c[3])]);let d=c||a.startsWith("#")?null:a.match(sm);d&&(o.push(fm(d,l,r)),l=[])}return{name:n?.[1]??"",
id:n?Number(n[2]):null,fields:o,indexOf:new Map(o.map((a,c)=>[a.name,c]))}}var pm="mavlink/msg/",ju=500,dm=1e4,mm=1e4,hm=8e3,mt=I(!1),Ho=I(null),kr=I(null),Tr=I(""),qt=I(0),at=new Map,as=new Map,
Mr=new Map,zo=new Map,qu=new Set,Xn=null,Sr=ju,wl=0,yl=0;function gm(e){if(!e.schemaName.startsWith(pm))return null;let t=as.
get(e.schemaName);if(t)return t;let n=Bu(e.schema);return as.set(e.schemaName,n),n}function Yu(e){Xn?.readyState===WebSocket.
OPEN&&Xn.send(JSON.stringify(e))}function Ku(e){let t=e.flatMap(n=>at.get(n)?.id??[]);t.length>0&&Yu({op:"subscribe",subscriptions:t.
map(n=>({id:n,channelId:n}))})}function vm(e){let t=at.get(e);t&&Yu({op:"unsubscribe",subscriptionIds:[t.id]})}function _m(e){
for(let t of e)at.set(t.topic,{id:t.id,topic:t.topic,encoding:t.encoding,schema:gm(t)}),Mr.set(t.id,t.topic);Ku(e.map(t=>t.
topic).filter(t=>zo.has(t))),kt(qt)}function bm(e){for(let t of e){let n=Mr.get(t);n!==void 0&&at.get(n)?.id===t&&at.delete(
n),Mr.delete(t)}kt(qt)}function xm(e){let t=JSON.parse(e);t.op==="advertise"?_m(t.channels??[]):t.op==="unadvertise"?bm(
t.channelIds??[]):t.op==="serverInfo"?Tr.value=t.name??"":t.op==="status"&&console.warn(t.message)}function wm(e){let t=new DataView(
e);if(t.byteLength<13||t.getUint8(0)!==1)return;let n=zo.get(Mr.get(t.getUint32(1,!0))??""),o=Number(t.getBigUint64(5,!0)/
1000n),r=new DataView(e,13);n?.forEach(l=>l(r,o))}function ym(){yl=performance.now(),Sr=ju,un(()=>{mt.value=!0,Ho.value=
kr.value=null});for(let e of qu)e()}function Zu(){clearTimeout(wl),Xn=null,at.clear(),Mr.clear(),as.clear(),un(()=>{(mt.
value||kr.value===null)&&(kr.value=Date.now()),mt.value=!1,Ho.value=Date.now()+Sr}),wl=window.setTimeout(Ar,Sr),Sr=Math.
min(dm,Sr*1.6)}function Ju(){document.addEventListener("visibilitychange",()=>{yl=performance.now()}),setInterval(()=>{if(!mt.
value||document.hidden||performance.now()-yl<mm)return;let e=Xn;Zu(),e?.close()},1e3)}function Ar(){if(clearTimeout(wl),
Xn)return;Ho.value=null;let e=new WebSocket(`${location.protocol==="https:"?"wss":"ws"}://${location.host}/`,["foxglove.\
sdk.v1","foxglove.websocket.v1"]);e.binaryType="arraybuffer",e.onopen=ym,e.onclose=()=>{Xn===e&&Zu()},e.onmessage=({data:t})=>{
yl=performance.now(),typeof t=="string"?xm(t):wm(t)},Xn=e,wl=window.setTimeout(()=>{e.readyState===WebSocket.CONNECTING&&
e.close()},hm)}function Uo(e,t){let n=zo.get(e)??new Set;return n.add(t),zo.set(e,n),n.size===1&&Ku([e]),()=>{n.delete(t),
!(n.size>0||zo.get(e)!==n)&&(zo.delete(e),vm(e))}}function Xu(e){qu.add(e),mt.value&&e()}var Sl=I(!document.hidden);document.addEventListener("visibilitychange",()=>{Sl.value=!document.hidden});var Sm=new TextDecoder,
Qn=class{constructor(t,n){this.take=n;Xu(()=>{this.loads.value+=1}),ze(()=>{if(!(this.wanted.value===0||!Sl.value||this.
loads.value===0))return this.isNew=!0,Uo(`/mavloom/${t}`,o=>this.apply(Sm.decode(o)))})}take;version=I(0);wanted=I(0);loads=I(
0);isNew=!0;use(){return this.wanted.value+=1,()=>{this.wanted.value-=1}}apply(t){this.take(JSON.parse(t),this.isNew),this.
isNew=!1,kt(this.version)}},us=0,Qu=0;function Er(e){us=e,Qu=performance.now()}function eo(){return us===0?Date.now()/1e3:
us/1e6+(mt.peek()?(performance.now()-Qu)/1e3:0)}var ht=I(0);setInterval(()=>{document.hidden||(ht.value+=1)},1e3);var kl=I([]),Ml=I([]),Wo=I([]),cs=I(0),gt=new Map,Tl=new Qn("vehicles",e=>{Er(e.time_us),kl.value=e.vehicles}),to=new Qn(
"alarms",e=>{Er(e.time_us),Wo.value=e.alarms,cs.value=e.left_out}),$n=e=>`${e.sys}/${e.comp}`;function fs(e){return Wo.value.
filter(t=>t.ended_us===null&&t.sys===e.sys&&(t.comp===null||t.comp===e.comp))}var ps=e=>e.autopilot!==null&&e.autopilot!==
"MAV_AUTOPILOT_INVALID"&&e.type!=="MAV_TYPE_GCS",ec=120,Nr=new Map,Al=e=>[e,...e.links].reduce((t,n)=>t+n.losses.reduce(
(o,r)=>o+r.count,0),0);function km(e){let t=Nr.get(e.name)??{rates:[],lost:[]};Nr.set(e.name,t),t.rates.push(Math.max(e.
hz_in??0,e.hz_out??0)),t.lost.push({at:performance.now()/1e3,total:Al(e)}),t.rates.length>ec&&t.rates.shift(),t.lost.length>
ec&&t.lost.shift()}function ds(e){let t=performance.now()/1e3,n=Nr.get(e.name)?.lost.find(o=>o.at>=t-10);return n?{count:Math.
max(0,Al(e)-n.total),seconds:Math.round(t-n.at)}:{count:0,seconds:0}}var wn=new Qn("links",e=>{Er(e.time_us),Ml.value=e.
hops,e.hops.forEach(km)}),tc=()=>Ml.value.flatMap(e=>e.hint??[]),nc=0,Mm=4e5,Tm=2e4,Am=60;function Em(e,t){let n=`${e.link??
""} ${e.topic}`,o=gt.get(n)?.newAt??(t<nc+Mm?0:t/1e6);gt.set(n,{...e,key:n,seenAt:t/1e6-(e.age_s??0),newAt:o})}function Nm(){
if(!(gt.size<=Tm))for(let e of gt.values())Go(e)>Am&&gt.delete(e.key)}var El=new Qn("traffic",(e,t)=>{Er(e.time_us),t&&(gt.
clear(),nc=e.time_us);for(let n of e.rows)Em(n,e.time_us);Nm()}),Go=e=>Math.max(0,eo()-e.seenAt),Nl=(e,t=Go(e))=>e.silent_after_s!=
null&&t>e.silent_after_s;function Pl(e,t=Go(e)){return Nl(e,t)?0:t>1.5&&t*e.hz>3?1/t:e.hz}var Pm=["overview","messages","plots"],no=["link","source","name","id","hz","count","bytes","share","gaps","jitter","age"],
Om=["source","name","hz","count","share","jitter","age"],ms=[10,30,60,300,900],Cl=8,hs=8;function rc(){return{view:"over\
view",query:"",sort:{column:"source",isDown:!1},columns:[...Om],opened:null,plots:[],span:60}}var Ol=e=>encodeURIComponent(
e).replace(/[~!']/g,t=>`%${t.charCodeAt(0).toString(16).toUpperCase()}`).replaceAll("%2F","/").replaceAll("%2C",",");function Fl(e){
try{return decodeURIComponent(e)}catch{return""}}function Fm(e){let t=[Ol(e.topic),Ol(e.formula),String(e.axis),String(e.
scale),String(e.offset)],n=["","","0","1","0"];for(;t.length>2&&t.at(-1)===n[t.length-1];)t.pop();return t.join("~")}var oc=(e,t)=>e!==
void 0&&e!==""&&Number.isFinite(Number(e))?Number(e):t;function Cm(e){let[t="",n="",o,r,l]=e.split("~");return t===""||n===
""?[]:[{topic:Fl(t),formula:Fl(n),axis:o==="1"?1:0,scale:oc(r,1),offset:oc(l,0)}]}function $l(e){let t=rc(),n=[],o=(r,l,a)=>{
l!==a&&n.push(`${r}=${l}`)};o("q",Ol(e.query),""),o("sort",`${e.sort.isDown?"-":""}${e.sort.column}`,t.sort.column),o("c\
ols",e.columns.join(","),t.columns.join(",")),o("open",Ol(e.opened??""),""),o("span",String(e.span),String(t.span));for(let r of e.
plots)n.push(`plot=${r.map(Fm).join("!")}`);return e.view+(n.length>0?`?${n.join("&")}`:"")}function $m(e,t){t.length>0&&
e.plots.push(t)}function Dm(e,t,n){if(t==="q"&&(e.query=Fl(n)),t==="open"&&(e.opened=Fl(n)||null),t==="span"&&ms.includes(
Number(n))&&(e.span=Number(n)),t==="cols"&&(e.columns=no.filter(r=>r==="name"||n.split(",").includes(r))),t==="plot"&&e.
plots.length<Cl&&$m(e,n.split("!").flatMap(Cm).slice(0,hs)),t!=="sort")return;let o=n.replace(/^-/,"");no.includes(o)&&(e.
sort={column:o,isDown:n.startsWith("-")})}function gs(e){let t=rc(),[n="",o=""]=e.replace(/^#/,"").split("?",2);Pm.includes(
n)&&(t.view=n);for(let r of o.split("&")){let l=r.indexOf("=");l>0&&Dm(t,r.slice(0,l),r.slice(l+1))}return t}var oo=gs(location.hash),He=I(oo.view),cn=I(oo.query),Yt=I(oo.sort),fn=I(oo.columns),ge=I(oo.opened),pe=I(oo.plots),pn=I(
oo.span),Mt=I(!1),Pr=I(""),lc=0;function Dl(e){Pr.value=e,clearTimeout(lc),lc=window.setTimeout(()=>{Pr.value=""},4e3)}function Lm(){
return{view:He.value,query:cn.value,sort:Yt.value,columns:fn.value,opened:ge.value,plots:pe.value,span:pn.value}}function Rm(e){
un(()=>{He.value=e.view,cn.value=e.query,Yt.value=e.sort,fn.value=e.columns,ge.value=e.opened,pe.value=e.plots,pn.value=
e.span})}function ic(){let e=`${He.value} ${ge.value}`;ze(()=>{let n=`#${$l(Lm())}`,o=`${He.value} ${ge.value}`;n!==location.
hash&&history[o===e?"replaceState":"pushState"](null,"",n),e=o});let t=()=>{let n=gs(location.hash);e=`${n.view} ${n.opened}`,
Rm(n)};addEventListener("popstate",t)}function Bo(e,t){return{topic:e,formula:t,axis:0,scale:1,offset:0}}function Or(e,t=pe.
value.length>0?pe.value.length-1:null){let n=t===null?void 0:pe.value[t];if(n?.some(r=>r.topic===e.topic&&r.formula===e.
formula))return Dl(`${e.formula} is in plot ${(t??0)+1} already`);if(n&&n.length<hs)return pe.value=pe.value.map((r,l)=>l===
t?[...r,e]:r),Dl(`${e.formula} added to plot ${(t??0)+1}`);if(pe.value.length===Cl)return Dl(`there are ${Cl} plots alre\
ady: remove one first`);pe.value=[...pe.value,[e]],Dl(`${e.formula} added to plot ${pe.value.length}`)}var Im=new Intl.NumberFormat("en-US"),ut=e=>e==null?"\u2013":Im.format(e);function De(e,t){return e==null||!Number.isFinite(
e)?"\u2013":e.toFixed(t).replace(/^-(?=[0.]*$)/,"")}function Tt(e){return e==null?"\u2013":e>0&&e<.05?"<0.1":e.toFixed(1)}
function Fr(e){if(e==null)return"\u2013";let t=["B","kB","MB","GB","TB"],n=0;for(;e>=1e3&&n<t.length-1;)e/=1e3,++n;return`${n===
0?e:e.toFixed(e<100?1:0)} ${t[n]}`}function Kt(e){return e==null||!Number.isFinite(e)?"\u2013":e<1?"<1 s":e<120?`${Math.
floor(e)} s`:e<7200?`${Math.floor(e/60)} min`:e<172800?`${Math.floor(e/3600)} h`:`${Math.floor(e/86400)} d`}var Vm=e=>String(
e).padStart(2,"0");function Ll(e){let t=new Date(e/1e3);return[t.getHours(),t.getMinutes(),t.getSeconds()].map(Vm).join(
":")}function Cr(e,t){if(typeof e=="string")return e;if(!t||typeof e=="bigint")return e.toString();if(!Number.isFinite(e))
return Number.isNaN(e)?"NaN":e>0?"\u221E":"\u2212\u221E";let n=Math.abs(e);return e!==0&&(n>=1e7||n<1e-6)?e.toExponential(
4):e.toFixed(n>=1e3?2:n>=100?3:n>=10?4:5)}function jo(e){let t=Math.abs(e);return Number.isFinite(e)?e!==0&&(t>=1e7||t<1e-4)?
e.toExponential(2):e.toFixed(t>=1e3?1:t>=100?2:t>=1?3:4):"\u2013"}var zm={px4:"PX4",ardupilotmega:"ArduPilot",gcs:"Groun\
d station",adsb:"ADS-B",vtol:"VTOL",generic:"Generic autopilot"};function $r(e,t){if(e==null)return"\u2013";let n=e.replace(
new RegExp(`^${t}`),"").replaceAll("_"," ").toLowerCase();return zm[n]??n.charAt(0).toUpperCase()+n.slice(1)}var Hm=Symbol.for("pv"),Um=0;function i(e,t,n,o,r,l){t||(t={});var a,c,d=t;if("ref"in d&&typeof e!="function")for(c in d={},t)c=="ref"?a=t[c]:d[c]=t[c];
var m={type:e,props:d,key:n,ref:a,__k:null,__:null,__b:0,__e:null,__c:null,constructor:Hm,__v:--Um,__i:-1,__u:0};return(r||
l)&&(m.__source=r,m.__self=l),re.vnode&&re.vnode(m),m}var Wm={error:"M8 1.5 15 14H1Z",warning:"M8 1 15 8 8 15 1 8Z",info:"M8 1.5a6.5 6.5 0 1 0 .01 0Z",live:"M8 3.5a4.5 4.5 0 \
1 0 .01 0Z",lost:"M3 3 13 13M13 3 3 13",connecting:"M8 2a6 6 0 1 1-6 6",down:"M3 3 13 13M13 3 3 13",up:"M8 3.5a4.5 4.5 0\
 1 0 .01 0Z",ended:"M3 8.5 6.5 12 13 4.5",auto:"M8 2a6 6 0 1 0 .01 0M8 2v12a6 6 0 0 0 0-12",light:"M8 5a3 3 0 1 0 .01 0M\
8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1",dark:"M13.5 9.5A6 6 0 1 1 6.5 2.5 5 5 0 0 0 1\
3.5 9.5Z",help:"M5.5 5.5a2.5 2.5 0 1 1 3.5 2.3c-.7.4-1 .8-1 1.7M8 12.5v.3",close:"M4 4 12 12M12 4 4 12",plot:"M2 2v12h12\
M4.5 10.5 7.5 6.5 10 9 13.5 4",pause:"M5.5 3v10M10.5 3v10",play:"M5 3 13 8 5 13Z",arrow:"M1 8h13M10 4l4 4-4 4"},Gm=["err\
or","warning","info","live","up","play"];function ue({name:e}){return i("svg",{class:`icon ${Gm.includes(e)?"filled":""}`,
viewBox:"0 0 16 16","aria-hidden":"true",children:i("path",{d:Wm[e]})})}var Rl=["auto","light","dark"],sc="mavloom-colours";function Bm(){let e=localStorage.getItem(sc);return Rl.includes(e)?e:
"auto"}var Dn=I(Bm()),vs=I(0);function _s(){document.documentElement.dataset.theme=Dn.value,vs.value+=1}function Il(){Dn.
value=Rl[(Rl.indexOf(Dn.value)+1)%Rl.length],localStorage.setItem(sc,Dn.value),_s()}matchMedia("(prefers-color-scheme: l\
ight)").addEventListener("change",_s);_s();function ro(e){let t=document.createElement("i");t.style.color=`var(--${e})`,
document.body.append(t);let n=getComputedStyle(t).color;return t.remove(),n}var nt=class extends Error{constructor(n,o){super(n);this.at=o}at},ac={pi:Math.PI,e:Math.E},uc=180/Math.PI,et=e=>({least:1,
most:1,call:e}),cc=e=>({least:2,most:2,call:e}),bs=e=>({least:1,most:1/0,call:e}),Ss={abs:et(Math.abs),acos:et(Math.acos),
asin:et(Math.asin),atan:et(Math.atan),atan2:cc(Math.atan2),ceil:et(Math.ceil),cos:et(Math.cos),deg:et(e=>e*uc),exp:et(Math.
exp),floor:et(Math.floor),hypot:bs(Math.hypot),log:et(Math.log),log10:et(Math.log10),max:bs(Math.max),min:bs(Math.min),mod:cc(
(e,t)=>e-t*Math.floor(e/t)),rad:et(e=>e/uc),round:et(Math.round),sign:et(Math.sign),sin:et(Math.sin),sqrt:et(Math.sqrt),
tan:et(Math.tan)},Ms=Object.keys(Ss),xs=/\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*)|([-+*/%^()[\],]))/y,
ws=/\s*(\/\d+\/\d+\/[A-Za-z_]\w*(?:\/\w+)?)\./y,ys=500,fc=50,jm=e=>e===void 0||e.kind==="sign"&&e.text!==")"&&e.text!=="\
]";function qm(e){let t=[],n=0;for(;e.slice(n).trim()!=="";){let o=n+(e.slice(n).length-e.slice(n).trimStart().length);ws.
lastIndex=xs.lastIndex=n;let r=jm(t.at(-1))?ws.exec(e):null,l=r??xs.exec(e);if(!l)throw new nt(`'${[...e.slice(o)][0]}' \
does not belong in a formula`,o);let[,a,c,d]=l,m=r?"topic":a?"number":c?"name":"sign";t.push({kind:m,text:a??c??d??"",at:o}),
n=r?ws.lastIndex:xs.lastIndex}return t.push({kind:"end",text:"",at:e.length}),t}var Ym={"+":(e,t)=>e+t,"-":(e,t)=>e-t},Km={
"*":(e,t)=>e*t,"/":(e,t)=>e/t,"%":(e,t)=>e%t},ks=class{constructor(t){this.all=t}all;uses=[];next=0;depth=0;whole(){let t=this.
sum();return this.token.kind!=="end"&&this.fail(`expected an operator before '${this.token.text}'`),t}get token(){return this.
all[this.next]}fail(t,n=this.token.at){throw new nt(t,n)}accept(t){return this.token.kind!=="sign"||this.token.text!==t?
!1:(++this.next,!0)}expect(t,n){this.accept(t)||this.fail(`expected '${t}' ${n}`)}chain(t,n){let o=n();for(let r=this.operator(
t);r;r=this.operator(t)){let l=o,a=n(),c=r;o=d=>c(l(d),a(d))}return o}operator(t){let{kind:n,text:o}=this.token;return n!==
"sign"||!Object.hasOwn(t,o)?null:(++this.next,t[o])}sum(){++this.depth>fc&&this.fail("too many parentheses");let t=this.
chain(Ym,()=>this.chain(Km,()=>this.signed()));return--this.depth,t}signed(){let t=!1;for(;;)if(this.accept("-"))t=!t;else if(!this.
accept("+"))break;let n=this.power();return t?o=>-n(o):n}power(){let t=this.primary();if(!this.accept("^"))return t;++this.
depth>fc&&this.fail("too many powers");let n=this.signed();return--this.depth,o=>t(o)**n(o)}primary(){let{kind:t,text:n,
at:o}=this.token;if(this.accept("(")){let r=this.sum();return this.expect(")","for the '(' before"),r}if(t==="end"&&this.
fail("the formula ends too early: a number or a field is missing"),t==="sign"&&this.fail(`expected a number or a field b\
efore '${n}'`),++this.next,t==="number"){let r=Number(n);return()=>r}return t==="topic"?this.fieldOf(n):this.accept("(")?
this.call(n,o):this.named(n,o)}fieldOf(t){let{kind:n,text:o,at:r}=this.token;return n!=="name"&&this.fail(`expected a fi\
eld of ${t}`),++this.next,this.field(t,o,r)}named(t,n){let o=Object.hasOwn(ac,t)?ac[t]:void 0,r=this.token.kind==="sign"&&
this.token.text==="[";return o!==void 0&&!r?()=>o:this.field(null,t,n)}field(t,n,o){let r=this.accept("[")?this.element():
null;return this.uses.push({topic:t,name:n,element:r,at:o}),l=>l(n,r,t)}element(){let{kind:t,text:n}=this.token;return(t!==
"number"||!/^\d+$/.test(n))&&this.fail("expected the number of an array element, as in [0]"),++this.next,this.expect("]",
"after the number of the element"),Number(n)}call(t,n){let o=Object.hasOwn(Ss,t)?Ss[t]:void 0;o||this.fail(`there is no \
function '${t}'; there are ${Ms.join(", ")}`,n);let r=this.arguments();if(r.length<o.least||r.length>o.most){let l=o.most===
1/0?"at least one value":o.least===1?"one value":`${o.least} values`;this.fail(`${t} takes ${l}, not ${r.length}`,n)}return l=>o.
call(...r.map(a=>a(l)))}arguments(){if(this.accept(")"))return[];let t=[this.sum()];for(;this.accept(",");)t.push(this.sum());
return this.expect(")","after the values of the function"),t}};function Dr(e){if(e.length>ys)throw new nt(`a formula has\
 at most ${ys} characters`,ys);let t=new ks(qm(e));return{formula:t.whole(),uses:t.uses}}var pc="mavloom-keys",qo=I(localStorage.getItem(pc)!=="off");function dc(){qo.value=!qo.value,localStorage.setItem(pc,qo.
value?"on":"off")}var Vl=new Map;function zl(e){for(let[t,n]of Object.entries(e))Vl.set(t,n);return()=>{for(let[t,n]of Object.
entries(e))Vl.get(t)===n&&Vl.delete(t)}}function Ln(e,t=10){requestAnimationFrame(()=>{let n=document.querySelector(e);n?
n.focus({preventScroll:!0}):t>0&&Ln(e,t-1)})}function Ts(){let e=ge.value,t=document.activeElement?.closest("aside.messa\
ge")!=null;if(ge.value=null,!t||e===null)return;(document.querySelector(`[data-row$="${CSS.escape(` ${e}`)}"]`)??document.
querySelector("main .scroller"))?.focus()}var Zm={1:()=>{He.value="overview"},2:()=>{He.value="messages"},3:()=>{He.value=
"plots"},"?":()=>{Mt.value=!Mt.value},t:Il,"/":()=>{He.value="messages",Ln("#search")}};function mc(e){return e instanceof
HTMLElement?e instanceof HTMLInputElement&&e.type!=="checkbox"||e instanceof HTMLTextAreaElement||e instanceof HTMLSelectElement:
!1}function Jm(){let e=document.querySelector("details[open]");return e&&(e.open=!1),e?.querySelector("summary")?.focus(),
e!==null}function Xm(e){if(Mt.value)Mt.value=!1;else{if(Jm())return;mc(e)?e.blur():Ts()}}function hc(e){if(e.ctrlKey||e.
metaKey||e.altKey||e.defaultPrevented)return;if(e.key==="Escape")return e.preventDefault(),Xm(e.target);if(mc(e.target)||
!qo.value&&e.key.length===1||e.key===" "&&e.target instanceof HTMLButtonElement)return;let t=Vl.get(e.key)??Zm[e.key];!t||
Mt.value&&e.key!=="?"||(e.preventDefault(),t(e))}var Qm=[["Everywhere",[["1 2 3","Overview, Messages, Plots"],["/","search messages"],["t","light, dark, as the system"],
["Esc","close, leave a field"],["?","this list"]]],["Messages",[["j k, \u2193 \u2191","next, previous row"],["Enter","op\
en the row"],["f","freeze the table"],["c","compare with the frozen state"],["Tab","to the open message: its close butto\
n, then its fields; Enter plots one"]]],["Plots",[["Space","stop, follow again"],["+ \u2212","zoom"],["\u2190 \u2192","e\
arlier, later"],["0","follow the latest"],["a","add a formula"]]]];function eh({title:e,keys:t}){return i("section",{children:[
i("h3",{children:e}),i("dl",{class:"keys",children:t.map(([n,o])=>[i("dt",{children:i("kbd",{children:n})},n),i("dd",{children:o},
o)])})]})}var th=()=>i("p",{children:["Formulas have fields, array elements such as ",i("code",{children:"voltages[0]"}),
", ",i("code",{children:"+ - * / % ^ ( )"}),","," ",i("code",{children:"pi"}),", ",i("code",{children:"e"})," and"," ",Ms.
map((e,t)=>[t>0?", ":"",i("code",{children:e},e)]),". A field of another topic has its name before it, as in ",i("code",
{children:"alt - /2/1/VFR_HUD.alt"}),": the latest value counts."]});function gc(){Mt.value=!1}function vc(){let e=Lt(null);
return Qe(()=>{Mt.value&&!e.current?.open&&e.current?.showModal(),!Mt.value&&e.current?.open&&e.current?.close()},[Mt.value]),
i("dialog",{ref:e,"aria-labelledby":"help-title",onClose:gc,children:[i("header",{children:[i("h2",{id:"help-title",children:"\
Keys"}),i("button",{class:"quiet",onClick:gc,"aria-label":"Close",children:i(ue,{name:"close"})})]}),i("div",{class:"gro\
ups",children:Qm.map(([t,n])=>i(eh,{title:t,keys:n},t))}),i("label",{class:"check",children:[i("input",{type:"checkbox",
checked:qo.value,onChange:dc})," Keys of one letter work"]}),i(th,{}),i("p",{class:"dim",children:[Tr.value," \xB7 ",i("\
a",{href:"licences.txt",children:"Licences of what this page contains"})]})]})}var Hl=4,nh=new TextDecoder;function _c(e){return e<=Number.MAX_SAFE_INTEGER&&e>=Number.MIN_SAFE_INTEGER?Number(e):e}var oh={
int8:(e,t)=>e.getInt8(t),uint8:(e,t)=>e.getUint8(t),int16:(e,t)=>e.getInt16(t,!0),uint16:(e,t)=>e.getUint16(t,!0),int32:(e,t)=>e.
getInt32(t,!0),uint32:(e,t)=>e.getUint32(t,!0),int64:(e,t)=>_c(e.getBigInt64(t,!0)),uint64:(e,t)=>_c(e.getBigUint64(t,!0)),
float32:(e,t)=>e.getFloat32(t,!0),float64:(e,t)=>e.getFloat64(t,!0)},As=class{constructor(t){this.data=t}data;at=Hl;field(t){
if(t.length===null)return this.scalar(t.type);let n=new Array(t.length);for(let o=0;o<t.length;++o)n[o]=this.scalar(t.type);
return n}scalar(t){let n=Gu(t);if(this.at=Hl+Math.ceil((this.at-Hl)/n)*n,t==="string")return this.text();let o=oh[t](this.
data,this.at);return this.at+=n,o}text(){let t=this.data.getUint32(this.at,!0),n=new Uint8Array(this.data.buffer,this.data.
byteOffset+this.at+4,Math.max(0,t-1));return this.at+=4+t,nh.decode(n)}};function Ul(e,t){if(t.byteLength<Hl||t.getUint8(
1)!==1)throw new RangeError("not a little-endian CDR message");let n=new As(t);return e.fields.map(o=>n.field(o))}function bc(e,t,n){
let o=e[t],r=Array.isArray(o)?o[n??0]:o;return typeof r=="string"||r===void 0?NaN:Number(r)}var Wl=I(0),Es=null;function Gl(){Wl.value,qt.value;let e=ge.value;if(e===null)return null;let t=Es?.topic===e?Es:null,n=t?.
schema??at.get(e)?.schema;if(!n)return null;let o={topic:e,schema:n,message:null,timeUs:t?.timeUs??0,error:""};if(!t)return o;
try{return{...o,message:Ul(n,t.data)}}catch(r){return{...o,error:String(r)}}}function xc(){ze(()=>{let e=ge.value;if(!(e===
null||!Sl.value))return Uo(e,(t,n)=>{let o=at.get(e)?.schema;o&&(Es={topic:e,schema:o,data:t,timeUs:n},kt(Wl))})})}var Ee=I(null),Rt=I(!1);function Bl(){Ee.value={at:eo(),opened:Gl(),rows:new Map(gt)},Rt.value=!1}function Ns(){Ee.value=
null,Rt.value=!1}function Ps(){Ee.value===null&&Bl(),Rt.value=!Rt.value}var yc=()=>Ee.value&&!Rt.value?Ee.value.rows:gt;
function Os(e){let t=Ee.value;return t&&!Rt.value?Nl(e,t.at-e.seenAt)?"silent":"":(t?!t.rows.has(e.key):e.newAt>0&&eo()-
e.newAt<10)?"new":Nl(e)?"silent":""}var Fs=e=>Ee.value&&!Rt.value?Math.max(0,Ee.value.at-e.seenAt):Go(e),Rr=e=>Pl(e,Fs(e));
function rh(e){let t=e.toLowerCase().split(/\s+/).filter(r=>r!==""),n=t.filter(r=>/^\d+\/\d*$/.test(r)),o=t.filter(r=>!n.
includes(r));return r=>{let l=`${r.sys}/${r.comp}`;return n.every(c=>c.endsWith("/")?l.startsWith(c):l===c)&&o.every(c=>lh(
r).includes(c))}}var wc=new WeakMap;function lh(e){let t=wc.get(e);if(t!==void 0)return t;let n=`${e.topic} ${e.link??""}\
 ${e.id}`.toLowerCase();return wc.set(e,n),n}var Yo=e=>e===0?0:Number(e.toPrecision(2)),ih={source:e=>e.sys*256+e.comp,id:e=>e.
id,hz:e=>Yo(Rr(e)),count:e=>Yo(e.count),bytes:e=>Yo(e.bytes),share:e=>Yo(e.share),gaps:e=>Yo(e.gap_max_ms??-1),jitter:e=>Yo(
e.jitter_ms??-1),age:e=>Math.floor(Go(e))},sh=(e,t)=>e.sys-t.sys||e.comp-t.comp||Lr(e.name,t.name)||ah(e.instance,t.instance)||
Lr(e.key,t.key),Lr=(e,t)=>e<t?-1:e>t?1:0,ah=(e,t)=>Number(e)-Number(t)||Lr(String(e??""),String(t??""));function uh(e){let t=ih[e];
return t?(n,o)=>t(n)-t(o):e==="link"?(n,o)=>Lr(n.link??"",o.link??""):(n,o)=>Lr(n.name,o.name)}function Sc(e,t,n){let o=uh(
n.column),r=n.isDown?-1:1;return[...e].filter(rh(t)).sort((l,a)=>r*o(l,a)||sh(l,a))}var kc=6;function ch(e){let t=Lt(null),[n,o]=Pu({top:0,height:800,row:26});Ro(()=>{let l=t.current;if(!l)return;let a=()=>{
let d=parseFloat(getComputedStyle(l).getPropertyValue("--row"))||26;o({top:l.scrollTop,height:l.clientHeight,row:d})},c=new ResizeObserver(
a);return c.observe(l),l.addEventListener("scroll",a,{passive:!0}),()=>{c.disconnect(),l.removeEventListener("scroll",a)}},
[]);let r=Math.max(0,Math.min(e,Math.floor(n.top/n.row)-kc));return{scroller:t,row:n.row,first:r,end:Math.min(e,Math.ceil(
(n.top+n.height)/n.row)+kc)}}function fh({columns:e,sort:t,onSort:n}){let o=t?.isDown?"descending":"ascending";return i(
"thead",{children:i("tr",{"aria-rowindex":1,children:e.map(r=>i("th",{scope:"col",title:r.help,class:`c-${r.key} ${r.isNumber?
"number":""}`,"aria-sort":t?.column===r.key?o:void 0,children:n&&r.label!==""?i("button",{onClick:()=>n(r.key),children:r.
label}):r.label},r.key))})})}var Mc=({rows:e,row:t})=>e<=0?null:i("tr",{class:"spacer","aria-hidden":"true",children:i("\
td",{style:{height:`${e*t}px`}})});function ph({current:e,rows:t,keyOf:n},o){Qe(()=>{let r=o.scroller.current,l=t.findIndex(
d=>n(d)===e);if(!r||l<0)return;let a=l*o.row,c=r.clientHeight-2*o.row;a<r.scrollTop?r.scrollTop=a:a>r.scrollTop+c&&(r.scrollTop=
a-c)},[e])}function dh({columns:e,row:t}){return i(te,{children:e.map(n=>i("td",{class:`c-${n.key} ${n.isNumber?"number":
""}`,children:n.cell(t)},n.key))})}function jl(e){let{caption:t,columns:n,rows:o,keyOf:r,classOf:l,current:a}=e,c=ch(o.length),
{scroller:d,row:m,first:g,end:_}=c,x=v=>`${l?.(v)??""} ${r(v)===a?"current":""}`;return ph(e,c),i("div",{class:"scroller",
ref:d,tabIndex:-1,children:i("table",{"aria-rowcount":o.length+1,children:[i("caption",{class:"hidden",children:t}),i("c\
olgroup",{children:n.map(v=>i("col",{class:`c-${v.key}`},v.key))}),i(fh,{...e}),i("tbody",{children:[i(Mc,{rows:g,row:m}),
o.slice(g,_).map((v,k)=>i("tr",{"aria-rowindex":g+k+2,class:x(v),children:dh({columns:n,row:v})},r(v))),i(Mc,{rows:o.length-
_,row:m})]})]})})}var mh={degE7:[1e-7,"\xB0",7],cdeg:[.01,"\xB0",2],rad:[180/Math.PI,"\xB0",2],"rad/s":[180/Math.PI,"\xB0/s",2],mm:[.001,"\
m",3],cm:[.01,"m",2],"cm/s":[.01,"m/s",2],"mm/s":[.001,"m/s",3],mV:[.001,"V",3],cV:[.01,"V",2],cA:[.01,"A",2],mA:[.001,"\
A",3],cdegC:[.01,"\xB0C",2],"c%":[.01,"%",2],"d%":[.1,"%",1]},Tc=e=>String(Math.floor(e)).padStart(2,"0"),hh=e=>`${Math.
floor(e/3600)}:${Tc(e/60%60)}:${Tc(e%60)}`;function Ac(e){return e>1e9?new Date(e*1e3).toISOString().slice(0,19).replace(
"T"," "):hh(e)}function Ec(e,t){let n=Number(e);if(!Number.isFinite(n))return"";if(t==="us"&&n>=1e6)return Ac(n/1e6);if(t===
"ms"&&n>=1e4)return Ac(n/1e3);let o=mh[t];if(!o)return"";let[r,l,a]=o;return`${Math.abs(n*r)>=1e6?jo(n*r):De(n*r,a)}${l.
startsWith("\xB0")&&l!=="\xB0C"&&l!=="\xB0/s"?"":" "}${l}`}function gh(e,t){let[,n,o,r]=e.match(/^(U?)INT(8|16|32|64)_(MAX|MIN)$/)??[];if(o===void 0)return vh(e,t)??(e.toLowerCase()===
"nan"?NaN:Number(e));let l=Number(o)-(n?0:1);return r==="MAX"?2**l-1:n?0:-(2**l)}var vh=(e,t)=>[...t.entries??[]].find(([
,n])=>n===e)?.[0];function Cs(e,t,n){if(t===""||e===void 0)return!1;let o=gh(t,n);return Number(e)===o||Number.isNaN(o)&&
Number.isNaN(Number(e))}function ql(e,t,n){let o=e.invalid;if(o===""||e.type==="string")return!1;let r=Array.isArray(t)?
t:[t],l=r[n??0];if(!o.startsWith("("))return Cs(l,o,e);let a=o.slice(1,-1);return a.endsWith(":")?Cs(r[0],a.slice(0,-1),
e):Cs(l,a.includes(",")?a.split(",")[n??0]??"":a,e)}var Ls="application/x-mavloom-series",$s=16,Yl=e=>e.type.startsWith("float"),Ds=I(new Set);function _h(e){let t=Ee.value?.
opened;return t?.topic===e.topic&&t.schema===e.schema?t.message:null}function bh(e,t){return[...e.entries??[]].filter(([
o])=>o!==0&&Math.floor(t/o)%2===1).map(([,o])=>Pc(o,e))}function Pc(e,t){let n=[...t.entries?.values()??[]];if(n.length<
2)return e;let o=0;for(;n.every(r=>r[o]===n[0]?.[o]&&o<r.length);)++o;return e.slice(n[0]?.lastIndexOf("_",o-1)===-1?0:(n[0]?.
lastIndexOf("_",o-1)??-1)+1)}var Oc=({field:e,whole:t,element:n})=>ql(e,t,n);function Fc(e){let{field:t,raw:n}=e;if(typeof n==
"string")return"";let o=t.entries?.get(Number(n));return o!==void 0?Pc(o,t):Oc(e)?"unknown":t.isFlags?bh(t,Number(n)).join(
", "):Ec(n,t.unit)}var Cc=({name:e})=>i(te,{children:e.split(/(?<=_)/).flatMap((t,n)=>n===0?[t]:[i("wbr",{},n),t])});function xh({
field:e,raw:t,formula:n}){let o=()=>Or(Bo(ge.value??"",n));return i("button",{class:"value mono",title:`Plot ${n}`,"aria\
-label":`Plot ${n}, ${Cr(t,Yl(e))}`,onClick:o,children:Cr(t,Yl(e))})}var $c=36,Nc=()=>Ee.value?5:4;function wh({field:e,
raw:t,before:n}){if(!Ee.value)return null;let o=n!==void 0&&!Object.is(n,t);return i("td",{class:`number mono ${o?"chang\
ed":"dim"}`,children:n===void 0?"":Cr(n,Yl(e))})}function yh(e){let{field:t,raw:n,formula:o}=e,r=Fc(e);return i(te,{children:[
i("td",{class:"number",children:i(xh,{field:t,raw:n,formula:o})}),i(wh,{...e}),i("td",{class:"dim f-unit",children:Oc(e)?
"":t.unit}),i("td",{class:"meaning",children:r.length>$c?"":r})]})}function Dc(e){let{field:t,raw:n,element:o}=e,r=o===null?
t.name:`${t.name}[${o}]`,l=typeof n=="string",a=l?n:Fc(e);return i(te,{children:[i("tr",{draggable:!l,onDragStart:d=>{d.
dataTransfer?.setData(Ls,JSON.stringify(Bo(ge.value??"",r))),d.dataTransfer?.setData("text/plain",r)},class:o===null?"":
"element",children:[i("th",{scope:"row",children:o===null?i(Cc,{name:t.name}):`[${o}]`}),l?i("td",{class:"text",colSpan:Nc()-
1,children:n}):i(yh,{...e,formula:r})]}),!l&&a.length>$c&&i("tr",{class:"more",children:i("td",{colSpan:Nc(),children:a})})]})}
function Sh(e){let t=new Set(Ds.value);t.delete(e)||t.add(e),Ds.value=t}function kh({field:e,all:t,isOpen:n,name:o}){let r=t.
slice(0,$s).map(a=>Cr(a,Yl(e))),l=`${t.length} elements`;return i("tr",{class:"array",children:[i("th",{scope:"row",children:i(
Cc,{name:e.name})}),i("td",{colSpan:Ee.value?2:1,class:"dim",children:t.length<=$s?l:i("button",{class:"link","aria-expa\
nded":n,onClick:()=>Sh(o),children:l})}),i("td",{class:"dim f-unit",children:e.unit}),i("td",{class:"meaning mono cut",children:n?
"":`${r.join(" ")} \u2026`})]})}function Mh({field:e,all:t,before:n}){let o=`${ge.value} ${e.name}`,r=t.length<=$s||Ds.value.
has(o),l=Array.isArray(n)?n:[];return i(te,{children:[i(kh,{field:e,all:t,isOpen:r,name:o}),r&&t.map((a,c)=>i(Dc,{field:e,
raw:a,whole:t,element:c,before:l[c]},c))]})}function Th({field:e,raw:t,before:n}){return Array.isArray(t)?i(Mh,{field:e,
all:t,before:n}):i(Dc,{field:e,raw:t,whole:t,before:n,element:null})}var Ah=()=>i("thead",{class:Ee.value?"":"hidden",children:i(
"tr",{children:[i("th",{scope:"col",children:"Field"}),i("th",{scope:"col",class:"number",children:"Value"}),Ee.value&&i(
"th",{scope:"col",class:"number",children:"Then"}),i("th",{scope:"col",class:"f-unit",children:"Unit"}),i("th",{scope:"c\
ol",children:"Meaning"})]})});function Eh({now:e}){let t=_h(e),{schema:n,message:o}=e;return o?i("table",{class:`fields ${Ee.
value?"compared":""}`,children:[i("caption",{class:"hidden",children:["Fields of ",n.name]}),i("colgroup",{children:[i("\
col",{class:"f-name"}),i("col",{class:"f-value"}),Ee.value&&i("col",{class:"f-value"}),i("col",{class:"f-unit"}),i("col",
{})]}),i(Ah,{}),i("tbody",{children:n.fields.map((r,l)=>i(Th,{field:r,raw:o[l],before:t?.[l]},r.name))})]}):i("p",{class:"\
empty",children:e.error||"No message has come yet."})}var Nh=()=>i("p",{class:"empty",children:qt.value>0&&mt.value?"Not\
hing with this name was heard.":"Waiting for the server."}),Ph=({topic:e})=>i("header",{children:[i("h3",{children:i("sp\
an",{class:"mono cut",title:e,children:e})}),i("button",{class:"quiet end",onClick:Ts,"aria-label":"Close the message",title:"\
Close (Esc)",children:i(ue,{name:"close"})})]});function Kl({hz:e}){Wl.value,ht.value;let t=Gl(),n=ge.value??"";return i(
"aside",{class:"message","aria-label":`Message ${n}`,children:[i(Ph,{topic:n}),i("p",{class:"dim number about",children:[
t&&`id ${t.schema.id}`,e!==null&&i("span",{children:[Tt(e)," /s"]}),t&&t.timeUs>0&&i("span",{children:["at ",Ll(t.timeUs)]})]}),
i("div",{class:"scroller",tabIndex:-1,children:t?i(Eh,{now:t}):i(Nh,{})}),i("p",{class:"hint dim",children:He.value==="p\
lots"?"Click a number, or drag it into a plot.":"Click a number to plot it."})]})}function Zl({text:e}){let t=tc();return wn.version.value===0?i("p",{class:"empty",children:"The server has not reported \
yet."}):t.length===0?i("p",{class:"empty",children:e}):i("ul",{class:"empty hints",children:t.map(n=>i("li",{children:[n,
"."]},n))})}var Zo=I(null),dn=St(()=>(El.version.value,Ee.value,Rt.value,Yt.value.column==="age"&&ht.value,Sc(yc().values(),cn.value,
Yt.value)));function Oh(e){Zo.value=e.key,ge.value=ge.value===e.topic?null:e.topic}function Fh({row:e}){let t=e.key===(Zo.
value??dn.value[0]?.key);return i("button",{class:"name mono","data-row":e.key,tabIndex:t?0:-1,"aria-expanded":ge.value===
e.topic,onClick:()=>Oh(e),onFocus:()=>{Zo.value=e.key},children:[e.name,e.instance!==null&&i("span",{class:"instance",children:[
"/",e.instance]})]})}function Ch(e){let t=Os(e);return t===""?null:i("span",{class:`mark ${t}`,children:t})}var $h=({row:e})=>{
let t=Ee.value?.rows.get(e.key);if(!t)return i(te,{children:"\u2013"});let n=Math.abs(t.hz-Pl(e))>.1*Math.max(t.hz,e.hz,
1);return i("span",{class:n?"changed":"dim",children:Tt(t.hz)})},Dh=({row:e})=>{let t=e.count-(Ee.value?.rows.get(e.key)?.
count??0);return i("span",{class:t===0?"dim":"",children:t>0?`+${ut(t)}`:ut(t)})},Lh=e=>e.gap_min_ms==null?"\u2013":`${De(
e.gap_min_ms,0)} \u2013 ${De(e.gap_max_ms,0)}`,Rc={mark:{key:"mark",label:"",cell:Ch},link:{key:"link",label:"Link",cell:e=>i(
"span",{class:"cut",title:e.link??"",children:e.link??"\u2013"})},source:{key:"source",label:"From",help:"system/compone\
nt",cell:e=>i("span",{class:"mono",children:[e.sys,"/",e.comp]})},name:{key:"name",label:"Message",cell:e=>i(Fh,{row:e})},
id:{key:"id",label:"Id",isNumber:!0,cell:e=>e.id},hz:{key:"hz",label:"Rate /s",isNumber:!0,cell:e=>Tt(Rr(e))},before:{key:"\
before",label:"Then /s",help:"the rate in the frozen state",isNumber:!0,cell:e=>i($h,{row:e})},count:{key:"count",label:"\
Count",isNumber:!0,cell:e=>ut(e.count)},more:{key:"more",label:"Since",help:"messages since the frozen state",isNumber:!0,
cell:e=>i(Dh,{row:e})},bytes:{key:"bytes",label:"Bytes",isNumber:!0,cell:e=>Fr(e.bytes)},share:{key:"share",label:"Share\
 %",help:"of the link's bytes",isNumber:!0,cell:e=>De(e.share*100,1)},gaps:{key:"gaps",label:"Gaps ms",help:"shortest an\
d longest time between two messages",isNumber:!0,cell:Lh},jitter:{key:"jitter",label:"Jitter ms",isNumber:!0,cell:e=>De(
e.jitter_ms,1)},age:{key:"age",label:"Age",help:"since the latest message",isNumber:!0,cell:e=>Kt(Fs(e))}},Rh={hz:["hz",
"before"],count:["count","more"],bytes:[],share:[],gaps:[],jitter:[]};function Ih(){let e=no.filter(o=>fn.value.includes(
o)),t=e.toSpliced(e.indexOf("name")+1,0,"mark");return(Rt.value?t.flatMap(o=>Rh[o]??[o]):t).flatMap(o=>Rc[o]??[])}function Vh(e){
if(!no.includes(e))return;let t=["source","name","link","id"].includes(e);Yt.value=Yt.value.column===e?{column:e,isDown:!Yt.
value.isDown}:{column:e,isDown:!t}}function zh(){let e=n=>{let o=fn.value.includes(n);fn.value=no.filter(r=>r===n?!o:fn.
value.includes(r))},t=Lt(null);return Qe(()=>{let n=o=>{t.current&&!t.current.contains(o.target)&&(t.current.open=!1)};return document.
addEventListener("pointerdown",n),()=>document.removeEventListener("pointerdown",n)},[]),i("details",{class:"chooser",ref:t,
children:[i("summary",{children:"Columns"}),i("div",{class:"menu",children:no.filter(n=>n!=="name").map(n=>i("label",{class:"\
check",children:[i("input",{type:"checkbox",checked:fn.value.includes(n),onChange:()=>e(n)})," ",Rc[n]?.label]},n))})]})}
function Hh(){let e=Ee.value;return i("span",{class:"group",children:[i("button",{"aria-pressed":e!==null,onClick:()=>e?
Ns():Bl(),title:"Freeze the table (f)",children:[i(ue,{name:e?"play":"pause"}),e?"Thaw":"Freeze"]}),e&&i("button",{"aria\
-pressed":Rt.value,onClick:Ps,title:"Live values beside the frozen ones (c)",children:"Compare"})]})}function Uh(){El.version.
value;let e=dn.value.reduce((n,o)=>n+Rr(o),0),t=Ee.value===null?"":Rt.value?" \xB7 live, compared":" \xB7 frozen";return i(
"span",{class:"summary dim number",role:"status","aria-live":"off",children:[ut(dn.value.length),dn.value.length<gt.size&&
` of ${ut(gt.size)}`," rows \xB7"," ",Math.round(e).toLocaleString("en-US")," /s",t]})}function Wh(){return i("div",{class:"\
toolbar",children:[i("input",{id:"search",type:"search",placeholder:"Search: 1/1 battery","aria-label":"Search messages",
value:cn.value,autocomplete:"off",spellcheck:!1,onInput:e=>{cn.value=e.currentTarget.value},onKeyDown:e=>{(e.key==="Ente\
r"||e.key==="ArrowDown")&&Jl(0)}}),i(Hh,{}),i(zh,{}),i(Uh,{})]})}function Jl(e){let t=dn.value[Math.max(0,Math.min(dn.value.
length-1,e))];t&&(Zo.value=t.key,Ln(`[data-row="${CSS.escape(t.key)}"]`))}var Lc=()=>dn.value.findIndex(e=>e.key===Zo.value),
Ko=e=>()=>Jl(Lc()<0?0:Lc()+e),Gh={j:Ko(1),ArrowDown:Ko(1),k:Ko(-1),ArrowUp:Ko(-1),PageDown:Ko(20),PageUp:Ko(-20),Home:()=>Jl(
0),End:()=>Jl(1/0),f:()=>Ee.value?Ns():Bl(),c:Ps};function Ic(){Qe(()=>El.use(),[]),Qe(()=>wn.use(),[]),Ro(()=>zl(Gh),[]),
ht.value;let e=dn.value.find(t=>t.topic===ge.value);return i(te,{children:[i("h2",{class:"hidden",children:"Messages"}),
i("div",{class:"list",children:[i(Wh,{}),i(jl,{caption:"Messages, a row for each sender, message and instance",columns:Ih(),
rows:dn.value,keyOf:t=>t.key,current:Zo.value,sort:Yt.value,onSort:Vh,classOf:t=>`${Os(t)} ${t.topic===ge.value?"open":""}`}),
gt.size===0&&i(Zl,{text:"No message has come yet."}),gt.size>0&&dn.value.length===0&&i("p",{class:"empty",children:"No m\
essage matches the search."})]}),ge.value!==null&&i(Kl,{hz:e?Rr(e):null})]})}var Rs=100;function Vc(e){return[e.sys===null?"":`${e.sys}${e.comp===null?"":`/${e.comp}`}`,e.link??""].filter(n=>n!=="").
join(" ")}function Bh({alarm:e}){let t=e.ended_us!==null,n=(t?(e.ended_us??0)/1e6:eo())-e.since_us/1e6;return i("li",{class:t?
"over":e.severity,children:[i("span",{class:"severity",children:[i(ue,{name:t?"ended":e.severity}),t?"over":e.severity]}),
i("time",{class:"number dim",dateTime:new Date(e.since_us/1e3).toISOString(),children:Ll(e.since_us)}),i("span",{class:"\
mono about",children:Vc(e)}),i("span",{class:"text",children:e.text}),i("span",{class:"lasted number dim",children:t?`la\
sted ${Kt(n)}`:`for ${Kt(n)}`})]})}function jh({alarm:e}){return i("p",{class:"hidden",role:"status","aria-live":"polite",
children:e?`${e.severity}: ${Vc(e)} ${e.text}`:""})}var qh=({number:e})=>e===0?null:i("li",{class:"note dim",children:[ut(
e)," older ",e===1?"one has":"ones have"," left the list, which was full"]});function zc(){to.version.value,ht.value;let e=[
...Wo.value].sort((n,o)=>+(n.ended_us!==null)-+(o.ended_us!==null)||o.since_us-n.since_us),t=e.filter(n=>n.ended_us===null);
return i("section",{"aria-labelledby":"alarms",children:[i("h2",{id:"alarms",children:["Alarms ",i("span",{class:"dim",children:t.
length>0?`${t.length} now`:""})]}),i(jh,{alarm:t[0]}),e.length===0&&(to.version.value===0?i("p",{class:"empty",children:"\
The server has not reported yet."}):i("p",{class:"empty",children:[i(ue,{name:"ended"}),"No alarm now, and none in the l\
ast ten minutes."]})),i("ul",{class:"alarms panel",hidden:e.length===0,children:[e.slice(0,Rs).map(n=>i(Bh,{alarm:n},n.id)),
e.length>Rs&&i("li",{class:"note dim",children:["and ",e.length-Rs," more"]}),i(qh,{number:cs.value})]})]})}var Hc=120,Is=22;function Yh({name:e}){wn.version.value;let t=Nr.get(e)?.rates??[],n=Math.max(1,...t),o=Hc-t.length+1,r=t.
map((l,a)=>`${o+a},${(Is-1-l/n*(Is-3)).toFixed(1)}`);return i("svg",{class:"trend",viewBox:`0 0 ${Hc} ${Is}`,preserveAspectRatio:"\
none",role:"img","aria-label":`frames a second in the last minute, at most ${Math.round(n)}`,children:r.length>1&&i("pol\
yline",{points:r.join(" ")})})}var Gc=({loss:e})=>i("li",{title:e.help,children:[i("span",{children:e.name.replaceAll("_",
" ")}),i("b",{class:"number",children:ut(e.count)}),e.help&&i("small",{children:e.help})]});function Kh({hop:e}){let{count:t,
seconds:n}=ds(e),o=Al(e);return o===0?i("p",{class:"fine",children:[i(ue,{name:"ended"}),"nothing lost here"]}):i("div",
{class:`losses ${t>0?"error":""}`,children:[i("p",{children:[i(ue,{name:t>0?"error":"info"}),ut(o)," lost",n>0&&i("span",
{class:"end",children:t>0?`+${ut(t)} in ${n} s`:`none in the last ${n} s`})]}),i("ul",{children:e.losses.map(r=>i(Gc,{loss:r},
r.name))})]})}var Zh={up:"up",down:"down",ended:"ended"};function Jh({link:e}){return i("li",{class:e.state,children:[i(
"span",{class:"link",title:e.name,children:[i(ue,{name:Zh[e.state]}),i("span",{class:"mono cut",children:e.name}),e.state!==
"up"&&` ${e.state}`]}),i("span",{class:"number dim",title:`${Fr(e.bytes_in)} in, ${Fr(e.bytes_out)} out`,children:[i("b",
{children:Tt(e.hz_in)})," in ",i("b",{children:Tt(e.hz_out)})," out"]}),e.losses.length>0&&i("ul",{class:"losses",children:e.
losses.map(t=>i(Gc,{loss:t},t.name))})]})}var Uc=({name:e,hz:t,frames:n})=>i("div",{children:[i("dt",{children:e}),i("dd",
{children:[i("b",{children:Tt(t)}),i("span",{class:"unit",children:"/s"})]}),i("dd",{class:"dim",children:ut(n)})]}),Bc=e=>e.
kind==="source"&&e.frames_in+e.frames_out===0,jc=e=>e.state!=="up"&&e.kind!=="station"&&!Bc(e),Xh=e=>Bc(e)?"waiting":jc(
e)?"down":"not here";function Qh({hop:e}){let t=e.state==="up",n=e.name.endsWith(e.kind)?"":e.kind;return i("header",{children:[
i("h3",{children:[i(ue,{name:t?"up":"down"}),i("span",{class:"cut",title:e.name,children:e.name})]}),i("span",{class:"en\
d dim",children:[i("span",{class:"kind",children:n})," ",t?"":Xh(e)]})]})}function eg({hop:e}){let t=`panel hop ${jc(e)?
"down":""} ${ds(e).count>0?"losing":""}`;return i("li",{class:t,children:[i(Qh,{hop:e}),i(Yh,{name:e.name}),i("dl",{class:"\
rates",children:[i(Uc,{name:"in",hz:e.hz_in,frames:e.frames_in}),i(Uc,{name:"out",hz:e.hz_out,frames:e.frames_out})]}),i(
Kh,{hop:e}),e.hint&&i("p",{class:"hint",children:e.hint}),e.links.length>0&&i("ul",{class:"links",children:e.links.map(n=>i(
Jh,{link:n},n.name))})]})}var Wc=({all:e})=>i("ol",{class:"hops",children:e.map((t,n)=>[n>0&&i("li",{class:"arrow","aria\
-hidden":"true",children:i(ue,{name:"arrow"})},`to ${t.name}`),i(eg,{hop:t},t.name)])});function qc(){wn.version.value;let e=Ml.
value,t=1+e.findIndex(n=>n.kind==="station")||e.length;return i("section",{"aria-labelledby":"hops",children:[i("h2",{id:"\
hops",children:["Hops"," ",i("span",{class:"dim",children:e.length>0&&`${t}, in the order in which frames pass them`})]}),
e.length===0&&i("p",{class:"empty",children:"The server has not reported yet."}),i(Wc,{all:e.slice(0,t)}),t<e.length&&i(
te,{children:[i("h3",{class:"aside dim",children:"Beside them, reading along"}),i(Wc,{all:e.slice(t)})]})]})}var tg=6,ng={GPS_FIX_TYPE_NO_GPS:"no GPS",GPS_FIX_TYPE_NO_FIX:"no fix",GPS_FIX_TYPE_2D_FIX:"2D",GPS_FIX_TYPE_3D_FIX:"3D",
GPS_FIX_TYPE_DGPS:"DGPS",GPS_FIX_TYPE_RTK_FLOAT:"RTK float",GPS_FIX_TYPE_RTK_FIXED:"RTK fixed",GPS_FIX_TYPE_STATIC:"stat\
ic",GPS_FIX_TYPE_PPP:"PPP"};function zs(e){return!e||e.fix===null?"\u2013":ng[e.fix]??$r(e.fix,"GPS_FIX_TYPE_")}var Yc=e=>[
"no GPS","no fix"].includes(zs(e)),Zc=e=>e?.heading_deg==null?"\u2013":String(Math.round(e.heading_deg)%360);function Jc(e){
let t=[["TIMESYNC",e.round_trip_ms?.timesync],["PING",e.round_trip_ms?.ping],["command",e.round_trip_ms?.command]],[n,o]=t.
find(([,r])=>r!=null)??["",null];return o?{text:o.last.toFixed(1),help:`${n}: least ${o.least.toFixed(1)} ms, mean ${o.mean.
toFixed(1)} ms of ${o.count}`}:{text:"\u2013",help:"no TIMESYNC, PING or command has been answered"}}function og(e){cn.value=
`${$n(e)} `,He.value="messages"}var Xc=({armed:e})=>e===null?i("span",{class:"dim",children:"\u2013"}):i("span",{class:`\
pill ${e?"armed":""}`,children:e?"ARMED":"disarmed"}),Qc=e=>e<=15?"error":e<=30?"warning":"";function ef({percent:e}){return e==
null?null:i("svg",{class:`gauge ${Qc(e)}`,viewBox:"0 0 100 10",preserveAspectRatio:"none","aria-hidden":"true",children:[
i("rect",{class:"empty",width:"100",height:"10"}),i("rect",{width:Math.max(0,Math.min(100,e)),height:"10"})]})}function tf({
battery:e}){let t=e?.percent;if(t==null)return i(te,{children:"\u2013"});let n=Qc(t);return i("span",{class:n,children:[
n!==""&&i(ue,{name:n}),Math.round(t)," %"]})}var nf=({all:e})=>{if(e.length===0)return null;let t=["error","warning","in\
fo"].find(n=>e.some(o=>o.severity===n))??"info";return i("span",{class:`mark ${t}`,title:e.map(n=>n.text).join(`
`),children:[i(ue,{name:t}),e.length]})},of=({one:e})=>i(te,{children:[i("b",{class:"mono",children:$n(e)})," ",$r(e.type,
"MAV_TYPE_")]}),Hs=({one:e})=>i("button",{class:"name",onClick:()=>og(e),title:"Show its messages",children:i(of,{one:e})}),
Xl=I(null),Vs=window.matchMedia("(max-width: 1380px)"),Us=I(Vs.matches);Vs.addEventListener("change",()=>{Us.value=Vs.matches});
function rg({one:e}){if(!Us.value)return i(Hs,{one:e});let t=$n(e),n=Xl.value===t;return i("button",{class:"name","aria-\
expanded":n,title:"Show its state",onClick:()=>{Xl.value=n?null:t,n||Ln(".panels.one .name")},children:i(of,{one:e})})}var Ql=({
name:e,title:t,children:n})=>i("div",{class:"pair",title:t,children:[i("dt",{children:e}),i("dd",{children:n})]}),yn=({name:e,
value:t,unit:n,help:o})=>i(Ql,{name:e,title:o,children:[t,t!=="\u2013"&&i("span",{class:"unit",children:n})]});function lg({
battery:e}){return i(te,{children:[i(Ql,{name:"Battery",children:[i(tf,{battery:e}),i(ef,{percent:e?.percent})]}),i(yn,{
name:"Voltage",value:De(e?.voltage_v,2),unit:"V"}),i(yn,{name:"Current",value:De(e?.current_a,1),unit:"A"})]})}function ig({
position:e}){return i(te,{children:[i(yn,{name:"Height",help:"above home",value:De(e?.relative_alt_m,1),unit:"m"}),i(yn,
{name:"Speed",help:"over ground",value:De(e?.ground_speed_m_s,1),unit:"m/s"}),i(yn,{name:"Heading",value:Zc(e),unit:"\xB0"}),
i(yn,{name:"Latitude",value:De(e?.lat_deg,6),unit:"\xB0"}),i(yn,{name:"Longitude",value:De(e?.lon_deg,6),unit:"\xB0"}),i(
yn,{name:"Altitude",help:"above mean sea level",value:De(e?.alt_m,1),unit:"m"})]})}function sg({one:e}){let{battery:t,gps:n,
position:o}=e,r=Jc(e);return i("dl",{class:"figures",children:[i(lg,{battery:t}),i(Ql,{name:"GPS",children:i("span",{class:Yc(
n)?"warning":"",children:[Yc(n)&&i(ue,{name:"warning"}),zs(n)]})}),i(Ql,{name:"Satellites",children:n?.satellites??"\u2013"}),
i(yn,{name:"Round trip",help:r.help,value:r.text,unit:"ms"}),i(ig,{position:o})]})}function Kc({one:e}){let t=fs(e);return i(
"article",{class:`panel vehicle ${e.silent?"silent":""}`,children:[i("header",{children:[i("h3",{children:i(Hs,{one:e})}),
i(nf,{all:t}),i("span",{class:"end dim",children:e.silent?i(te,{children:[i(ue,{name:"lost"}),"silent for ",Kt(e.age_s)]}):
`${Tt(e.hz)} /s`})]}),i("p",{class:"mode",children:[i("strong",{children:e.mode??"\u2013"}),i(Xc,{armed:e.armed}),i("spa\
n",{class:"end dim",children:[$r(e.status,"MAV_STATE_")," \xB7 ",$r(e.autopilot,"MAV_AUTOPILOT_")]})]}),i(sg,{one:e})]})}
var ag=[{key:"vehicle",label:"Vehicle",cell:e=>i(rg,{one:e})},{key:"marks",label:"Alarms",cell:e=>i(nf,{all:fs(e)})},{key:"\
mode",label:"Mode",cell:e=>e.mode??"\u2013"},{key:"armed",label:"Armed",cell:e=>i(Xc,{armed:e.armed})},{key:"percent",label:"\
Battery",isNumber:!0,cell:e=>i(te,{children:[i(ef,{percent:e.battery?.percent}),i(tf,{battery:e.battery})]})},{key:"volt\
age",label:"V",isNumber:!0,cell:e=>De(e.battery?.voltage_v,2)},{key:"fix",label:"GPS",cell:e=>zs(e.gps)},{key:"satellite\
s",label:"Sats",isNumber:!0,cell:e=>e.gps?.satellites??"\u2013"},{key:"height",label:"Height m",isNumber:!0,cell:e=>De(e.
position?.relative_alt_m,1)},{key:"speed",label:"m/s",isNumber:!0,cell:e=>De(e.position?.ground_speed_m_s,1)},{key:"head\
ing",label:"Heading",isNumber:!0,cell:e=>Zc(e.position)},{key:"lat",label:"Latitude",isNumber:!0,cell:e=>De(e.position?.
lat_deg,6)},{key:"lon",label:"Longitude",isNumber:!0,cell:e=>De(e.position?.lon_deg,6)},{key:"trip",label:"Trip ms",help:"\
round trip",isNumber:!0,cell:e=>Jc(e).text},{key:"rate",label:"/s",help:"messages a second",isNumber:!0,cell:e=>Tt(e.hz)},
{key:"age",label:"Age",isNumber:!0,cell:e=>Kt(e.age_s)}];function ug({all:e}){return e.length===0?null:i("ul",{class:"ot\
hers","aria-label":"Other components",children:[e.slice(0,40).map(t=>i("li",{class:t.silent?"silent":"",children:[i(Hs,{
one:t})," ",i("span",{class:"dim",children:t.silent?`silent for ${Kt(t.age_s)}`:`${Tt(t.hz)} /s`})]},$n(t))),e.length>40&&
i("li",{class:"dim",children:["and ",e.length-40," more"]})]})}function cg({all:e}){let t=Us.value?e.find(n=>$n(n)===Xl.
value):void 0;return e.length>tg?i(te,{children:[t&&i("div",{class:"panels one",children:i(Kc,{one:t})}),i(jl,{caption:"\
Vehicles",columns:ag,rows:e,keyOf:$n,current:t?Xl.value:null,classOf:n=>`${n.silent?"silent":""} ${n===t?"open":""}`})]}):
i("div",{class:"panels",children:e.map(n=>i(Kc,{one:n},$n(n)))})}function rf(){Tl.version.value,ht.value;let e=kl.value.
filter(ps).sort((n,o)=>n.sys-o.sys||n.comp-o.comp),t=e.filter(n=>n.silent).length;return i("section",{"aria-labelledby":"\
vehicles",children:[i("h2",{id:"vehicles",children:["Vehicles"," ",i("span",{class:"dim",children:[e.length>0&&e.length,
t>0&&`, ${t} silent`]})]}),e.length===0&&i(Zl,{text:"No vehicle has sent a HEARTBEAT yet."}),i(cg,{all:e}),i(ug,{all:kl.
value.filter(n=>!ps(n))})]})}function lf(){return Qe(()=>{let e=[Tl.use(),wn.use(),to.use()];return()=>e.forEach(t=>t())},[]),i(te,{children:[i(rf,{}),
i(qc,{}),i(zc,{})]})}var Ws=2e4;function Ir(e,t,n,o){for(;n<o;){let r=n+o>>1;e[r]<t?n=r+1:o=r}return n}var ei=class{times=new Float64Array(2*
Ws);values=new Float64Array(2*Ws);first=0;end=0;get length(){return this.end-this.first}get latest(){return this.end>this.
first?this.values[this.end-1]:NaN}get latestTime(){return this.end>this.first?this.times[this.end-1]:-1/0}add(t,n){this.
end===this.times.length&&this.compact(),this.times[this.end]=t,this.values[this.end++]=n,this.length>Ws&&++this.first}range(t,n){
let o=Math.max(this.first,Ir(this.times,t,this.first,this.end)-1),r=Math.min(this.end,Ir(this.times,n,this.first,this.end)+
2);return[this.times.subarray(o,r),this.values.subarray(o,r)]}clear(){this.first=this.end=0}compact(){this.times.copyWithin(
0,this.first,this.end),this.values.copyWithin(0,this.first,this.end),this.end-=this.first,this.first=0}};function fg(e,t){
let n=[...Array(t.length+1).keys()];for(let o=0;o<e.length;++o){let r=[o+1];for(let l=0;l<t.length;++l)r.push(Math.min(r[l]+
1,n[l+1]+1,n[l]+(e[o]===t[l]?0:1)));n=r}return n[t.length]}function pg(e,t){let n=t.fields.filter(r=>r.type!=="string").
map(r=>({name:r.name,score:fg(e.toLowerCase(),r.name)-(r.name.startsWith(e)?3:0)}));n.sort((r,l)=>r.score-l.score);let o=n[0];
return o&&o.score<=3?`; is it ${o.name}?`:`; it has ${t.fields.map(r=>r.name).join(", ")}`}function dg({name:e,element:t,
at:n},o){let r=o.fields[o.indexOf.get(e)??-1];if(!r)throw new nt(`${o.name} has no field ${e}${pg(e,o)}`,n);if(r.type===
"string")throw new nt(`${e} is text, not a number`,n);if(r.length!==null&&t===null)throw new nt(`${e} is an array: choos\
e an element, from ${e}[0] to ${e}[${r.length-1}]`,n);if(r.length===null&&t!==null)throw new nt(`${e} is not an array`,n);
if(t!==null&&t>=(r.length??0))throw new nt(`${e} has ${r.length} elements, the last is ${e}[${(r.length??1)-1}]`,n)}function mg(e,t,n,o){
let r=e.indexOf.get(n)??-1,l=e.fields[r],a=t[r];return l&&a!==void 0&&ql(l,a,o)?NaN:bc(t,r,o)}var Vr=class{constructor(t,n){
this.parsed=t;this.own=n;let o=new Set(t.uses.map(r=>r.topic??n));this.topics=o.size>0?[...o]:[n]}parsed;own;topics;latest=new Map;check(t){
for(let n of this.parsed.uses){let o=t(n.topic??this.own);o&&dg(n,o)}}take(t,n,o){return this.latest.set(t,{schema:n,message:Ul(
n,o)}),this.latest.size<this.topics.length?null:this.parsed.formula((r,l,a)=>{let c=this.latest.get(a??this.own);return c?
mg(c.schema,c.message,r,l):NaN})}};function sf(e,t,n){let[,o,r]=e.trim().match(/^(?:(\/\S+)\.)?(\w+)(?:\[\d+\])?$/)??[],
l=n(o??t);return l?.fields[l.indexOf.get(r??"")??-1]?.unit??""}function af(e,t){try{return t||(Dr(e).uses.find(n=>n.topic!==
null)?.topic??"")}catch{return t}}function uf(e,t,n){try{let o=Dr(e),r=o.uses.find(l=>l.topic===null&&t==="");return r?new nt(
`choose a topic, or write it here, as in /1/1/VFR_HUD.${r.name}`,r.at):(new Vr(o,t).check(n),null)}catch(o){if(o instanceof
nt)return o;throw o}}var Zt=I(0),ti=e=>at.get(e)?.schema??null,Gs=class{constructor(t,n){this.topic=t;this.formula=n;this.attempt(()=>{let o=new Vr(
Dr(n),t);this.evaluator=o,this.stopWanting=o.topics.map(r=>Uo(r,(l,a)=>this.take(o,r,l,a)))}),this.compile()}topic;formula;points=new ei;fault=null;unit="";total=0;arrivedMs=0;evaluator=null;schemas=[];stopWanting=[];compile(){
let{evaluator:t}=this,n=t?.topics.map(ti)??[];n.every((o,r)=>o===this.schemas[r])||(this.schemas=n,this.attempt(()=>{t?.
check(ti),this.unit=sf(this.formula,this.topic,ti),this.fault=null}))}interrupt(){this.points.length>0&&!Number.isNaN(this.
points.latest)&&this.points.add(this.points.latestTime,NaN)}stop(){for(let t of this.stopWanting)t()}attempt(t){try{t()}catch(n){
this.fault=n instanceof nt?n:new nt(String(n),0)}}take(t,n,o,r){this.compile();let l=ti(n);if(!l||this.fault)return;let a=t.
take(n,l,o);if(a===null)return;let c=r/1e6;c<this.points.latestTime-5&&this.points.clear(),this.points.add(Math.max(c,this.
points.latestTime),a),++this.total,this.arrivedMs=performance.now(),kt(Zt)}},lo=new Map,io=e=>`${e.topic} ${e.formula}`,
mn=e=>lo.get(io(e));function hg(e){let t=new Set(e.map(io));for(let[n,o]of lo)t.has(n)||(o.stop(),lo.delete(n));for(let n of e)
lo.has(io(n))||lo.set(io(n),new Gs(n.topic,n.formula));kt(Zt)}function cf(){ze(()=>hg(pe.value.flat())),ze(()=>{qt.value,
lo.forEach(e=>e.compile())}),ze(()=>{mt.value||lo.forEach(e=>e.interrupt())})}var It=I(null),Bs=new Map,ff=0,pf=()=>pe.value.flat().reduce((e,t)=>e+(mn(t)?.total??0),0),df=()=>Math.max(0,pf()-ff);function gg(){
let e=-1/0;for(let t of pe.value.flat()){let n=mn(t);if(!n||n.points.length===0)continue;let o=Math.min((performance.now()-
n.arrivedMs)/1e3,pn.value/2);e=Math.max(e,n.points.latestTime+o)}return Number.isFinite(e)?e:Date.now()/1e3}function Jt(){
let e=gg();return It.value??{from:e-pn.value,to:e}}function so(e=Jt()){if(It.value===null){ff=pf();for(let t of pe.value.
flat()){let n=mn(t)?.points.range(-1/0,1/0);n&&Bs.set(io(t),[n[0].slice(),n[1].slice()])}}It.value=e,kt(Zt)}function zr(){
Bs.clear(),It.value=null,kt(Zt)}function hn(e,t=.5){let{from:n,to:o}=Jt(),r=Math.min(7200,Math.max(.05,(o-n)*e)),l=n+(o-
n)*t;so({from:l-r*t,to:l+r*(1-t)})}function Hr(e){let{from:t,to:n}=Jt(),o=(n-t)*e;so({from:t+o,to:n+o})}function ao(e,{from:t,
to:n}){let o=It.value===null?void 0:Bs.get(io(e));if(!o)return mn(e)?.points.range(t,n)??[new Float64Array,new Float64Array];
let r=Math.max(0,Ir(o[0],t,0,o[0].length)-1),l=Ir(o[0],n,0,o[0].length)+2;return[o[0].subarray(r,l),o[1].subarray(r,l)]}
function mf([e,t],n){if(e.length<=4*n)return[e,t];let o=[];for(let r=0;r<n;++r){let l=Math.floor(r*e.length/n),a=Math.floor(
(r+1)*e.length/n),c=l,d=l;for(let m=l;m<a;++m)t[m]>=t[c]||(c=m),t[m]<=t[d]||(d=m);for(let m of c<d?[c,d]:[d,c])o.push([e[m],
t[m]])}return[Float64Array.from(o,r=>r[0]),Float64Array.from(o,r=>r[1])]}function hf(e,t){let n=document.createElement("a");n.href=URL.createObjectURL(t),n.download=e,n.click(),setTimeout(()=>URL.
revokeObjectURL(n.href),1e4)}var gf=e=>`mavloom-${new Date().toISOString().slice(0,19).replace("T","-").replaceAll(":","")}\
.${e}`,vg=e=>/[",\n]/.test(e)?`"${e.replaceAll('"','""')}"`:e;function js({topic:e,formula:t,scale:n,offset:o}){let r=n===
1?"":` * ${n}`;return`${e} ${t}${r}${o===0?"":` + ${o}`}`}function _g(e){let t=new Map,n=Jt();e.forEach((r,l)=>{let[a,c]=ao(
r,n);for(let d=0;d<a.length;++d){let m=a[d],g=c[d];if(m<n.from||m>n.to||Number.isNaN(g))continue;let _=t.get(m)??e.map(()=>"");
_[l]=String(g*r.scale+r.offset),t.set(m,_)}});let o=[...t].sort(([r],[l])=>r-l).map(([r,l])=>[r.toFixed(6),...l].join(","));
return[["time_s",...e.map(r=>vg(js(r)))].join(","),...o,""].join(`
`)}var vf=e=>hf(gf("csv"),new Blob([_g(e)],{type:"text/csv"}));function _f(e,t){let n=devicePixelRatio||1,o=24*n,r=document.
createElement("canvas");r.width=e.width,r.height=e.height+o;let l=r.getContext("2d");if(!l)return;l.fillStyle=ro("panel"),
l.fillRect(0,0,r.width,r.height),l.drawImage(e,0,o),l.font=`${12*n}px system-ui, sans-serif`,l.textBaseline="middle";let a=12*
n;t.forEach((c,d)=>{l.fillStyle=ro(`series-${d%8}`),l.fillText(js(c),a,o/2),a+=l.measureText(js(c)).width+24*n}),r.toBlob(
c=>{c&&hf(gf("png"),c)})}var bg="uplot",xg="u-hz",wg="u-vt",yg="u-title",Sg="u-wrap",kg="u-under",Mg="u-over",Tg="u-axis",fo="u-off",Ag="u-select",
Eg="u-cursor-x",Ng="u-cursor-y",Pg="u-cursor-pt",Og="u-legend",Fg="u-live",Cg="u-inline",$g="u-series",Dg="u-marker",bf="\
u-label",Lg="u-value",Wr="width",Gr="height";var xf="bottom",Jo="left",qs="right",ca="#000",wf=ca+"0",Ys="mousemove",yf="mousedown",Ks="mouseup",Sf="mouseenter",kf="\
mouseleave",Mf="dblclick",Rg="resize",Ig="scroll",Tf="change",ii="dppxchange",fa="--",rr=typeof window<"u",ea=rr?document:
null,Qo=rr?window:null,Vg=rr?navigator:null,ce,ni;function ta(){let e=devicePixelRatio;ce!=e&&(ce=e,ni&&oa(Tf,ni,ta),ni=
matchMedia(`(min-resolution: ${ce-.001}dppx) and (max-resolution: ${ce+.001}dppx)`),po(Tf,ni,ta),Qo.dispatchEvent(new CustomEvent(
ii)))}function At(e,t){if(t!=null){let n=e.classList;!n.contains(t)&&n.add(t)}}function na(e,t){let n=e.classList;n.contains(
t)&&n.remove(t)}function Se(e,t,n){e.style[t]=n+"px"}function Xt(e,t,n,o){let r=ea.createElement(e);return t!=null&&At(r,
t),n?.insertBefore(r,o),r}function Vt(e,t){return Xt("div",e,t)}var Af=new WeakMap;function gn(e,t,n,o,r){let l="transla\
te("+t+"px,"+n+"px)",a=Af.get(e);l!=a&&(e.style.transform=l,Af.set(e,l),t<0||n<0||t>o||n>r?At(e,fo):na(e,fo))}var Ef=new WeakMap;
function Nf(e,t,n){let o=t+n,r=Ef.get(e);o!=r&&(Ef.set(e,o),e.style.background=t,e.style.borderColor=n)}var Pf=new WeakMap;
function Of(e,t,n,o){let r=t+""+n,l=Pf.get(e);r!=l&&(Pf.set(e,r),e.style.height=n+"px",e.style.width=t+"px",e.style.marginLeft=
o?-t/2+"px":0,e.style.marginTop=o?-n/2+"px":0)}var pa={passive:!0},zg={...pa,capture:!0};function po(e,t,n,o){t.addEventListener(
e,n,o?zg:pa)}function oa(e,t,n,o){t.removeEventListener(e,n,pa)}rr&&ta();function Qt(e,t,n,o){let r;n=n||0,o=o||t.length-
1;let l=o<=2147483647;for(;o-n>1;)r=l?n+o>>1:Et((n+o)/2),t[r]<e?n=r:o=r;return e-t[n]<=t[o]-e?n:o}function lp(e){return(n,o,r)=>{
let l=-1,a=-1;for(let c=o;c<=r;c++)if(e(n[c])){l=c;break}for(let c=r;c>=o;c--)if(e(n[c])){a=c;break}return[l,a]}}var ip=e=>e!=
null,sp=e=>e!=null&&e>0,ui=lp(ip),Hg=lp(sp);function Ug(e,t,n,o=0,r=!1){let l=r?Hg:ui,a=r?sp:ip;[t,n]=l(e,t,n);let c=e[t],
d=e[t];if(t>-1)if(o==1)c=e[t],d=e[n];else if(o==-1)c=e[n],d=e[t];else for(let m=t;m<=n;m++){let g=e[m];a(g)&&(g<c?c=g:g>
d&&(d=g))}return[c??ve,d??-ve]}function ci(e,t,n,o){let r=$f(e),l=$f(t);e==t&&(r==-1?(e*=n,t/=n):(e/=n,t*=n));let a=n==10?
Sn:ap,c=r==1?Et:zt,d=l==1?zt:Et,m=c(a(We(e))),g=d(a(We(t))),_=er(n,m),x=er(n,g);return n==10&&(m<0&&(_=_e(_,-m)),g<0&&(x=
_e(x,-g))),o||n==2?(e=_*r,t=x*l):(e=pp(e,_),t=fi(t,x)),[e,t]}function da(e,t,n,o){let r=ci(e,t,n,o);return e==0&&(r[0]=0),
t==0&&(r[1]=0),r}var ma=.1,Ff={mode:3,pad:ma},jr={pad:0,soft:null,mode:0},Wg={min:jr,max:jr};function si(e,t,n,o){return pi(
n)?Cf(e,t,n):(jr.pad=n,jr.soft=o?0:null,jr.mode=o?3:0,Cf(e,t,Wg))}function se(e,t){return e??t}function Gg(e,t,n){for(t=
se(t,0),n=se(n,e.length-1);t<=n;){if(e[t]!=null)return!0;t++}return!1}function Cf(e,t,n){let o=n.min,r=n.max,l=se(o.pad,
0),a=se(r.pad,0),c=se(o.hard,-ve),d=se(r.hard,ve),m=se(o.soft,ve),g=se(r.soft,-ve),_=se(o.mode,0),x=se(r.mode,0),v=t-e,k=Sn(
v),N=ct(We(e),We(t)),E=Sn(N),F=We(E-k);(v<1e-24||F>10)&&(v=0,(e==0||t==0)&&(v=1e-24,_==2&&m!=ve&&(l=0),x==2&&g!=-ve&&(a=
0)));let w=v||N||1e3,P=Sn(w),S=er(10,Et(P)),K=w*(v==0?e==0?.1:1:l),L=_e(pp(e-K,S/10),24),Z=e>=m&&(_==1||_==3&&L<=m||_==2&&
L>=m)?m:ve,G=ct(c,L<Z&&e>=Z?Z:en(Z,L)),X=w*(v==0?t==0?.1:1:a),W=_e(fi(t+X,S/10),24),A=t<=g&&(x==1||x==3&&W>=g||x==2&&W<=
g)?g:-ve,B=en(d,W>A&&t<=A?A:ct(A,W));return G==B&&G==0&&(B=100),[G,B]}var Bg=new Intl.NumberFormat(rr?Vg.language:"en-US"),
ha=e=>Bg.format(e),Nt=Math,li=Nt.PI,We=Nt.abs,Et=Nt.floor,Ue=Nt.round,zt=Nt.ceil,en=Nt.min,ct=Nt.max,er=Nt.pow,$f=Nt.sign,
Sn=Nt.log10,ap=Nt.log2,jg=(e,t=1)=>Nt.sinh(e)*t,Zs=(e,t=1)=>Nt.asinh(e/t),ve=1/0;function Df(e){return(Sn((e^e>>31)-(e>>
31))|0)+1}function ra(e,t,n){return en(ct(e,t),n)}function up(e){return typeof e=="function"}function ne(e){return up(e)?
e:()=>e}var qg=()=>{},cp=e=>e,fp=(e,t)=>t,Yg=e=>null,Lf=e=>!0,Rf=(e,t)=>e==t,Kg=/\.\d*?(?=9{6,}|0{6,})/gm,mo=e=>{if(mp(e)||
In.has(e))return e;let t=`${e}`,n=t.match(Kg);if(n==null)return e;let o=n[0].length-1;if(t.indexOf("e-")!=-1){let[r,l]=t.
split("e");return+`${mo(r)}e${l}`}return _e(e,o)};function uo(e,t){return mo(_e(mo(e/t))*t)}function fi(e,t){return mo(zt(
mo(e/t))*t)}function pp(e,t){return mo(Et(mo(e/t))*t)}function _e(e,t=0){if(mp(e))return e;let n=10**t,o=e*n*(1+Number.EPSILON);
return Ue(o)/n}var In=new Map;function dp(e){return((""+e).split(".")[1]||"").length}function Yr(e,t,n,o){let r=[],l=o.map(
dp);for(let a=t;a<n;a++){let c=We(a),d=_e(er(e,a),c);for(let m=0;m<o.length;m++){let g=e==10?+`${o[m]}e${a}`:o[m]*d,_=(a>=
0?0:c)+(a>=l[m]?0:l[m]),x=e==10?g:_e(g,_);r.push(x),In.set(x,_)}}return r}var qr={},ga=[],tr=[null,null],Rn=Array.isArray,
mp=Number.isInteger,Zg=e=>e===void 0;function If(e){return typeof e=="string"}function pi(e){let t=!1;if(e!=null){let n=e.
constructor;t=n==null||n==Object}return t}function Jg(e){return e!=null&&typeof e=="object"}var Xg=Object.getPrototypeOf(
Uint8Array),hp="__proto__";function nr(e,t=pi){let n;if(Rn(e)){let o=e.find(r=>r!=null);if(Rn(o)||t(o)){n=Array(e.length);
for(let r=0;r<e.length;r++)n[r]=nr(e[r],t)}else n=e.slice()}else if(e instanceof Xg)n=e.slice();else if(t(e)){n={};for(let o in e)
o!=hp&&(n[o]=nr(e[o],t))}else n=e;return n}function Le(e){let t=arguments;for(let n=1;n<t.length;n++){let o=t[n];for(let r in o)
r!=hp&&(pi(e[r])?Le(e[r],nr(o[r])):e[r]=nr(o[r]))}return e}var Qg=0,ev=1,tv=2;function nv(e,t,n){for(let o=0,r,l=-1;o<t.
length;o++){let a=t[o];if(a>l){for(r=a-1;r>=0&&e[r]==null;)e[r--]=null;for(r=a+1;r<n&&e[r]==null;)e[l=r++]=null}}}function ov(e,t){
if(iv(e)){let a=e[0].slice();for(let c=1;c<e.length;c++)a.push(...e[c].slice(1));return sv(a[0])||(a=lv(a)),a}let n=new Set;
for(let a=0;a<e.length;a++){let d=e[a][0],m=d.length;for(let g=0;g<m;g++)n.add(d[g])}let o=[Array.from(n).sort((a,c)=>a-
c)],r=o[0].length,l=new Map;for(let a=0;a<r;a++)l.set(o[0][a],a);for(let a=0;a<e.length;a++){let c=e[a],d=c[0];for(let m=1;m<
c.length;m++){let g=c[m],_=Array(r).fill(void 0),x=t?t[a][m]:ev,v=[];for(let k=0;k<g.length;k++){let N=g[k],E=l.get(d[k]);
N===null?x!=Qg&&(_[E]=N,x==tv&&v.push(E)):_[E]=N}nv(_,v,r),o.push(_)}}return o}var rv=typeof queueMicrotask>"u"?e=>Promise.
resolve().then(e):queueMicrotask;function lv(e){let t=e[0],n=t.length,o=Array(n);for(let l=0;l<o.length;l++)o[l]=l;o.sort(
(l,a)=>t[l]-t[a]);let r=[];for(let l=0;l<e.length;l++){let a=e[l],c=Array(n);for(let d=0;d<n;d++)c[d]=a[o[d]];r.push(c)}
return r}function iv(e){let t=e[0][0],n=t.length;for(let o=1;o<e.length;o++){let r=e[o][0];if(r.length!=n)return!1;if(r!=
t){for(let l=0;l<n;l++)if(r[l]!=t[l])return!1}}return!0}function sv(e,t=100){let n=e.length;if(n<=1)return!0;let o=0,r=n-
1;for(;o<=r&&e[o]==null;)o++;for(;r>=o&&e[r]==null;)r--;if(r<=o)return!0;let l=ct(1,Et((r-o+1)/t));for(let a=e[o],c=o+l;c<=
r;c+=l){let d=e[c];if(d!=null){if(d<=a)return!1;a=d}}return!0}var gp=["January","February","March","April","May","June",
"July","August","September","October","November","December"],vp=["Sunday","Monday","Tuesday","Wednesday","Thursday","Fri\
day","Saturday"];function _p(e){return e.slice(0,3)}var av=vp.map(_p),uv=gp.map(_p),cv={MMMM:gp,MMM:uv,WWWW:vp,WWW:av};function Ur(e){
return(e<10?"0":"")+e}function fv(e){return(e<10?"00":e<100?"0":"")+e}var pv={YYYY:e=>e.getFullYear(),YY:e=>(e.getFullYear()+
"").slice(2),MMMM:(e,t)=>t.MMMM[e.getMonth()],MMM:(e,t)=>t.MMM[e.getMonth()],MM:e=>Ur(e.getMonth()+1),M:e=>e.getMonth()+
1,DD:e=>Ur(e.getDate()),D:e=>e.getDate(),WWWW:(e,t)=>t.WWWW[e.getDay()],WWW:(e,t)=>t.WWW[e.getDay()],HH:e=>Ur(e.getHours()),
H:e=>e.getHours(),h:e=>{let t=e.getHours();return t==0?12:t>12?t-12:t},AA:e=>e.getHours()>=12?"PM":"AM",aa:e=>e.getHours()>=
12?"pm":"am",a:e=>e.getHours()>=12?"p":"a",mm:e=>Ur(e.getMinutes()),m:e=>e.getMinutes(),ss:e=>Ur(e.getSeconds()),s:e=>e.
getSeconds(),fff:e=>fv(e.getMilliseconds())};function va(e,t){t=t||cv;let n=[],o=/\{([a-z]+)\}|[^{]+/gi,r;for(;r=o.exec(
e);)n.push(r[0][0]=="{"?pv[r[1]]:r[0]);return l=>{let a="";for(let c=0;c<n.length;c++)a+=typeof n[c]=="string"?n[c]:n[c](
l,t);return a}}var dv=new Intl.DateTimeFormat().resolvedOptions().timeZone;function mv(e,t){let n;return t=="UTC"||t=="E\
tc/UTC"?n=new Date(+e+e.getTimezoneOffset()*6e4):t==dv?n=e:(n=new Date(e.toLocaleString("en-US",{timeZone:t})),n.setMilliseconds(
e.getMilliseconds())),n}var bp=e=>e%1==0,ai=[1,2,2.5,5],hv=Yr(10,-32,0,ai),xp=Yr(10,0,32,ai),gv=xp.filter(bp),co=hv.concat(
xp),_a=`
`,wp="{YYYY}",Vf=_a+wp,yp="{M}/{D}",Br=_a+yp,oi=Br+"/{YY}",Sp="{aa}",vv="{h}:{mm}",Xo=vv+Sp,zf=_a+Xo,Hf=":{ss}",de=null;
function kp(e){let t=e*1e3,n=t*60,o=n*60,r=o*24,l=r*30,a=r*365,d=(e==1?Yr(10,0,3,ai).filter(bp):Yr(10,-3,0,ai)).concat([
t,t*5,t*10,t*15,t*30,n,n*5,n*10,n*15,n*30,o,o*2,o*3,o*4,o*6,o*8,o*12,r,r*2,r*3,r*4,r*5,r*6,r*7,r*8,r*9,r*10,r*15,l,l*2,l*
3,l*4,l*6,a,a*2,a*5,a*10,a*25,a*50,a*100]),m=[[a,wp,de,de,de,de,de,de,1],[r*28,"{MMM}",Vf,de,de,de,de,de,1],[r,yp,Vf,de,
de,de,de,de,1],[o,"{h}"+Sp,oi,de,Br,de,de,de,1],[n,Xo,oi,de,Br,de,de,de,1],[t,Hf,oi+" "+Xo,de,Br+" "+Xo,de,zf,de,1],[e,Hf+
".{fff}",oi+" "+Xo,de,Br+" "+Xo,de,zf,de,1]];function g(_){return(x,v,k,N,E,F)=>{let w=[],P=E>=a,S=E>=l&&E<a,K=_(k),L=_e(
K*e,3),Z=Js(K.getFullYear(),P?0:K.getMonth(),S||P?1:K.getDate()),G=_e(Z*e,3);if(S||P){let X=S?E/l:0,W=P?E/a:0,A=L==G?L:_e(
Js(Z.getFullYear()+W,Z.getMonth()+X,1)*e,3),B=new Date(Ue(A/e)),C=B.getFullYear(),q=B.getMonth();for(let U=0;A<=N;U++){let oe=Js(
C+W*U,q+X*U,1),H=oe-_(_e(oe*e,3));A=_e((+oe+H)*e,3),A<=N&&w.push(A)}}else{let X=E>=r?r:E,W=Et(k)-Et(L),A=G+W+fi(L-G,X);w.
push(A);let B=_(A),C=B.getHours()+B.getMinutes()/n+B.getSeconds()/o,q=E/o,U=x.axes[v]._space,oe=F/U;for(;A=_e(A+E,e==1?0:
3),!(A>N);)if(q>1){let H=Et(_e(C+q,6))%24,le=_(A).getHours()-H;le>1&&(le=-1),A-=le*o,C=(C+q)%24;let me=w[w.length-1];_e(
(A-me)/E,3)*oe>=.7&&w.push(A)}else w.push(A)}return w}}return[d,m,g]}var[_v,bv,xv]=kp(1),[wv,yv,Sv]=kp(.001);Yr(2,-53,53,
[1]);function Uf(e,t){return e.map(n=>n.map((o,r)=>r==0||r==8||o==null?o:t(r==1||n[8]==0?o:n[1]+o)))}function Wf(e,t){return(n,o,r,l,a)=>{
let c=t.find(k=>a>=k[0])||t[t.length-1],d,m,g,_,x,v;return o.map(k=>{let N=e(k),E=N.getFullYear(),F=N.getMonth(),w=N.getDate(),
P=N.getHours(),S=N.getMinutes(),K=N.getSeconds(),L=E!=d&&c[2]||F!=m&&c[3]||w!=g&&c[4]||P!=_&&c[5]||S!=x&&c[6]||K!=v&&c[7]||
c[1];return d=E,m=F,g=w,_=P,x=S,v=K,L(N)})}}function kv(e,t){let n=va(t);return(o,r,l,a,c)=>r.map(d=>n(e(d)))}function Js(e,t,n){
return new Date(e,t,n)}function Gf(e,t){return t(e)}var Mv="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function Bf(e,t){return(n,o,r,l)=>l==
null?fa:t(e(o))}function Tv(e,t){let n=e.series[t];return n.width?n.stroke(e,t):n.points.width?n.points.stroke(e,t):null}
function Av(e,t){return e.series[t].fill(e,t)}var Ev={show:!0,live:!0,isolate:!1,mount:qg,markers:{show:!0,width:2,stroke:Tv,
fill:Av,dash:"solid"},idx:null,idxs:null,values:[]};function Nv(e,t){let n=e.cursor.points,o=Vt(),r=n.size(e,t);Se(o,Wr,
r),Se(o,Gr,r);let l=r/-2;Se(o,"marginLeft",l),Se(o,"marginTop",l);let a=n.width(e,t,r);return a&&Se(o,"borderWidth",a),o}
function Pv(e,t){let n=e.series[t].points;return n._fill||n._stroke}function Ov(e,t){let n=e.series[t].points;return n._stroke||
n._fill}function Fv(e,t){return e.series[t].points.size}var Xs=[0,0];function Cv(e,t,n){return Xs[0]=t,Xs[1]=n,Xs}function ri(e,t,n,o=!0){
return r=>{r.button==0&&(!o||r.target==t)&&n(r)}}function Qs(e,t,n,o=!0){return r=>{(!o||r.target==t)&&n(r)}}var $v={show:!0,
x:!0,y:!0,lock:!1,move:Cv,points:{one:!1,show:Nv,size:Fv,width:0,stroke:Ov,fill:Pv},bind:{mousedown:ri,mouseup:ri,click:ri,
dblclick:ri,mousemove:Qs,mouseleave:Qs,mouseenter:Qs},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(e,t)=>{t.stopPropagation(),
t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(e,t,n,o,r)=>o-r,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},
left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Mp={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},ba=Le({},Mp,
{filter:fp}),Tp=Le({},ba,{size:10}),Ap=Le({},Mp,{show:!1}),xa='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helve\
tica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',
Ep="bold "+xa,Np=1.5,jf={show:!0,scale:"x",stroke:ca,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Ep,
side:2,grid:ba,ticks:Tp,border:Ap,font:xa,lineGap:Np,rotate:0},Dv="Value",Lv="Time",qf={show:!0,scale:"x",auto:!1,sorted:1,
min:ve,max:-ve,idxs:[]};function Rv(e,t,n,o,r){return t.map(l=>l==null?"":ha(l))}function Iv(e,t,n,o,r,l,a){let c=[],d=In.
get(r)||0;n=a?n:_e(fi(n,r),d);for(let m=n;m<=o;m=_e(m+r,d))c.push(Object.is(m,-0)?0:m);return c}function la(e,t,n,o,r,l,a){
let c=[],d=e.scales[e.axes[t].scale].log,m=d==10?Sn:ap,g=Et(m(n));r=er(d,g),d==10&&(r=co[Qt(r,co)]);let _=n,x=r*d;d==10&&
(x=co[Qt(x,co)]);do c.push(_),_=_+r,d==10&&!In.has(_)&&(_=_e(_,In.get(r))),_>=x&&(r=_,x=r*d,d==10&&(x=co[Qt(x,co)]));while(_<=
o);return c}function Vv(e,t,n,o,r,l,a){let d=e.scales[e.axes[t].scale].asinh,m=o>d?la(e,t,ct(d,n),o,r):[d],g=o>=0&&n<=0?
[0]:[];return(n<-d?la(e,t,ct(d,-o),-n,r):[d]).reverse().map(x=>-x).concat(g,m)}var Pp=/./,zv=/[12357]/,Hv=/[125]/,Yf=/1/,
ia=(e,t,n,o)=>e.map((r,l)=>t==4&&r==0||l%o==0&&n.test(r.toExponential()[r<0?1:0])?r:null);function Uv(e,t,n,o,r){let l=e.
axes[n],a=l.scale,c=e.scales[a],d=e.valToPos,m=l._space,g=d(10,a),_=d(9,a)-g>=m?Pp:d(7,a)-g>=m?zv:d(5,a)-g>=m?Hv:Yf;if(_==
Yf){let x=We(d(1,a)-g);if(x<m)return ia(t.slice().reverse(),c.distr,_,zt(m/x)).reverse()}return ia(t,c.distr,_,1)}function Wv(e,t,n,o,r){
let l=e.axes[n],a=l.scale,c=l._space,d=e.valToPos,m=We(d(1,a)-d(2,a));return m<c?ia(t.slice().reverse(),3,Pp,zt(c/m)).reverse():
t}function Gv(e,t,n,o){return o==null?fa:t==null?"":ha(t)}var Kf={show:!0,scale:"y",stroke:ca,space:30,gap:5,alignTo:1,size:50,
labelGap:0,labelSize:30,labelFont:Ep,side:3,grid:ba,ticks:Tp,border:Ap,font:xa,lineGap:Np,rotate:0};function Bv(e,t){let n=3+
(e||1)*2;return _e(n*t,3)}function jv(e,t){let{scale:n,idxs:o}=e.series[0],r=e._data[0],l=e.valToPos(r[o[0]],n,!0),a=e.valToPos(
r[o[1]],n,!0),c=We(a-l),d=e.series[t],m=c/(d.points.space*ce);return o[1]-o[0]<=m}var Zf={scale:null,auto:!0,sorted:0,min:ve,
max:-ve},Op=(e,t,n,o,r)=>r,Jf={show:!0,auto:!0,sorted:0,gaps:Op,alpha:1,facets:[Le({},Zf,{scale:"x"}),Le({},Zf,{scale:"y"})]},
Xf={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:Op,alpha:1,points:{show:jv,filter:null},values:null,min:ve,max:-ve,
idxs:[],path:null,clip:null};function qv(e,t,n,o,r){return n/10}var Fp={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,
max:null,dir:1,ori:0},Yv=Le({},Fp,{time:!1,ori:1}),Qf={};function Cp(e,t){let n=Qf[e];return n||(n={key:e,plots:[],sub(o){
n.plots.push(o)},unsub(o){n.plots=n.plots.filter(r=>r!=o)},pub(o,r,l,a,c,d,m){for(let g=0;g<n.plots.length;g++)n.plots[g]!=
r&&n.plots[g].pub(o,r,l,a,c,d,m)}},e!=null&&(Qf[e]=n)),n}var or=1,sa=2;function ho(e,t,n){let o=e.mode,r=e.series[t],l=o==
2?e._data[t]:e._data,a=e.scales,c=e.bbox,d=l[0],m=o==2?l[1]:l[t],g=o==2?a[r.facets[0].scale]:a[e.series[0].scale],_=o==2?
a[r.facets[1].scale]:a[r.scale],x=c.left,v=c.top,k=c.width,N=c.height,E=e.valToPosH,F=e.valToPosV;return g.ori==0?n(r,d,
m,g,_,E,F,x,v,k,N,mi,lr,gi,Dp,Rp):n(r,d,m,g,_,F,E,v,x,N,k,hi,ir,Sa,Lp,Ip)}function wa(e,t){let n=0,o=0,r=se(e.bands,ga);
for(let l=0;l<r.length;l++){let a=r[l];a.series[0]==t?n=a.dir:a.series[1]==t&&(a.dir==1?o|=1:o|=2)}return[n,o==1?-1:o==2?
1:o==3?2:0]}function Kv(e,t,n,o,r){let l=e.mode,a=e.series[t],c=l==2?a.facets[1].scale:a.scale,d=e.scales[c];return r==-1?
d.min:r==1?d.max:d.distr==3?d.dir==1?d.min:d.max:0}function kn(e,t,n,o,r,l){return ho(e,t,(a,c,d,m,g,_,x,v,k,N,E)=>{let F=a.
pxRound,w=m.dir*(m.ori==0?1:-1),P=m.ori==0?lr:ir,S,K;w==1?(S=n,K=o):(S=o,K=n);let L=F(_(c[S],m,N,v)),Z=F(x(d[S],g,E,k)),
G=F(_(c[K],m,N,v)),X=F(x(l==1?g.max:g.min,g,E,k)),W=new Path2D(r);return P(W,G,X),P(W,L,X),P(W,L,Z),W})}function di(e,t,n,o,r,l){
let a=null;if(e.length>0){a=new Path2D;let c=t==0?gi:Sa,d=n;for(let _=0;_<e.length;_++){let x=e[_];if(x[1]>x[0]){let v=x[0]-
d;v>0&&c(a,d,o,v,o+l),d=x[1]}}let m=n+r-d,g=10;m>0&&c(a,d,o-g/2,m,o+l+g)}return a}function Zv(e,t,n){let o=e[e.length-1];
o&&o[0]==t?o[1]=n:e.push([t,n])}function ya(e,t,n,o,r,l,a){let c=[],d=e.length;for(let m=r==1?n:o;m>=n&&m<=o;m+=r)if(t[m]===
null){let _=m,x=m;if(r==1)for(;++m<=o&&t[m]===null;)x=m;else for(;--m>=n&&t[m]===null;)x=m;let v=l(e[_]),k=x==_?v:l(e[x]),
N=_-r;v=a<=0&&N>=0&&N<d?l(e[N]):v;let F=x+r;k=a>=0&&F>=0&&F<d?l(e[F]):k,k>=v&&c.push([v,k])}return c}function ep(e){return e==
0?cp:e==1?Ue:t=>uo(t,e)}function $p(e){let t=e==0?mi:hi,n=e==0?(r,l,a,c,d,m)=>{r.arcTo(l,a,c,d,m)}:(r,l,a,c,d,m)=>{r.arcTo(
a,l,d,c,m)},o=e==0?(r,l,a,c,d)=>{r.rect(l,a,c,d)}:(r,l,a,c,d)=>{r.rect(a,l,d,c)};return(r,l,a,c,d,m=0,g=0)=>{m==0&&g==0?
o(r,l,a,c,d):(m=en(m,c/2,d/2),g=en(g,c/2,d/2),t(r,l+m,a),n(r,l+c,a,l+c,a+d,m),n(r,l+c,a+d,l,a+d,g),n(r,l,a+d,l,a,g),n(r,
l,a,l+c,a,m),r.closePath())}}var mi=(e,t,n)=>{e.moveTo(t,n)},hi=(e,t,n)=>{e.moveTo(n,t)},lr=(e,t,n)=>{e.lineTo(t,n)},ir=(e,t,n)=>{
e.lineTo(n,t)},gi=$p(0),Sa=$p(1),Dp=(e,t,n,o,r,l)=>{e.arc(t,n,o,r,l)},Lp=(e,t,n,o,r,l)=>{e.arc(n,t,o,r,l)},Rp=(e,t,n,o,r,l,a)=>{
e.bezierCurveTo(t,n,o,r,l,a)},Ip=(e,t,n,o,r,l,a)=>{e.bezierCurveTo(n,t,r,o,a,l)};function Vp(e){return(t,n,o,r,l)=>ho(t,
n,(a,c,d,m,g,_,x,v,k,N,E)=>{let{pxRound:F,points:w}=a,P,S;m.ori==0?(P=mi,S=Dp):(P=hi,S=Lp);let K=_e(w.width*ce,3),L=(w.size-
w.width)/2*ce,Z=_e(L*2,3),G=new Path2D,X=new Path2D,{left:W,top:A,width:B,height:C}=t.bbox;gi(X,W-Z,A-Z,B+Z*2,C+Z*2);let q=U=>{
if(d[U]!=null){let oe=F(_(c[U],m,N,v)),H=F(x(d[U],g,E,k));P(G,oe+L,H),S(G,oe,H,L,0,li*2)}};if(l)l.forEach(q);else for(let U=o;U<=
r;U++)q(U);return{stroke:K>0?G:null,fill:G,clip:X,flags:or|sa}})}function zp(e){return(t,n,o,r,l,a)=>{o!=r&&(l!=o&&a!=o&&
e(t,n,o),l!=r&&a!=r&&e(t,n,r),e(t,n,a))}}var Jv=zp(lr),Xv=zp(ir);function Hp(e){let t=se(e?.alignGaps,0);return(n,o,r,l)=>ho(
n,o,(a,c,d,m,g,_,x,v,k,N,E)=>{[r,l]=ui(d,r,l);let F=a.pxRound,w=C=>F(_(C,m,N,v)),P=C=>F(x(C,g,E,k)),S,K;m.ori==0?(S=lr,K=
Jv):(S=ir,K=Xv);let L=m.dir*(m.ori==0?1:-1),Z={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:or},G=Z.stroke,
X=!1;if(l-r>=N*4){let C=V=>n.posToVal(V,m.key,!0),q=null,U=null,oe,H,ft,ke=w(c[L==1?r:l]),le=w(c[r]),me=w(c[l]),Q=C(L==1?
le+1:me-1);for(let V=L==1?r:l;V>=r&&V<=l;V+=L){let Re=c[V],Me=(L==1?Re<Q:Re>Q)?ke:w(Re),fe=d[V];Me==ke?fe!=null?(H=fe,q==
null?(S(G,Me,P(H)),oe=q=U=H):H<q?q=H:H>U&&(U=H)):fe===null&&(X=!0):(q!=null&&K(G,ke,P(q),P(U),P(oe),P(H)),fe!=null?(H=fe,
S(G,Me,P(H)),q=U=oe=H):(q=U=null,fe===null&&(X=!0)),ke=Me,Q=C(ke+L))}q!=null&&q!=U&&ft!=ke&&K(G,ke,P(q),P(U),P(oe),P(H))}else
for(let C=L==1?r:l;C>=r&&C<=l;C+=L){let q=d[C];q===null?X=!0:q!=null&&S(G,w(c[C]),P(q))}let[A,B]=wa(n,o);if(a.fill!=null||
A!=0){let C=Z.fill=new Path2D(G),q=a.fillTo(n,o,a.min,a.max,A),U=P(q),oe=w(c[r]),H=w(c[l]);L==-1&&([H,oe]=[oe,H]),S(C,H,
U),S(C,oe,U)}if(!a.spanGaps){let C=[];X&&C.push(...ya(c,d,r,l,L,w,t)),Z.gaps=C=a.gaps(n,o,r,l,C),Z.clip=di(C,m.ori,v,k,N,
E)}return B!=0&&(Z.band=B==2?[kn(n,o,r,l,G,-1),kn(n,o,r,l,G,1)]:kn(n,o,r,l,G,B)),Z})}function Qv(e){let t=se(e.align,1),
n=se(e.ascDesc,!1),o=se(e.alignGaps,0),r=se(e.extend,!1);return(l,a,c,d)=>ho(l,a,(m,g,_,x,v,k,N,E,F,w,P)=>{[c,d]=ui(_,c,
d);let S=m.pxRound,{left:K,width:L}=l.bbox,Z=le=>S(k(le,x,w,E)),G=le=>S(N(le,v,P,F)),X=x.ori==0?lr:ir,W={stroke:new Path2D,
fill:null,clip:null,band:null,gaps:null,flags:or},A=W.stroke,B=x.dir*(x.ori==0?1:-1),C=G(_[B==1?c:d]),q=Z(g[B==1?c:d]),U=q,
oe=q;r&&t==-1&&(oe=K,X(A,oe,C)),X(A,q,C);for(let le=B==1?c:d;le>=c&&le<=d;le+=B){let me=_[le];if(me==null)continue;let Q=Z(
g[le]),V=G(me);t==1?X(A,Q,C):X(A,U,V),X(A,Q,V),C=V,U=Q}let H=U;r&&t==1&&(H=K+L,X(A,H,C));let[ft,ke]=wa(l,a);if(m.fill!=null||
ft!=0){let le=W.fill=new Path2D(A),me=m.fillTo(l,a,m.min,m.max,ft),Q=G(me);X(le,H,Q),X(le,oe,Q)}if(!m.spanGaps){let le=[];
le.push(...ya(g,_,c,d,B,Z,o));let me=m.width*ce/2,Q=n||t==1?me:-me,V=n||t==-1?-me:me;le.forEach(Re=>{Re[0]+=Q,Re[1]+=V}),
W.gaps=le=m.gaps(l,a,c,d,le),W.clip=di(le,x.ori,E,F,w,P)}return ke!=0&&(W.band=ke==2?[kn(l,a,c,d,A,-1),kn(l,a,c,d,A,1)]:
kn(l,a,c,d,A,ke)),W})}function tp(e,t,n,o,r,l,a=ve){if(e.length>1){let c=null;for(let d=0,m=1/0;d<e.length;d++)if(t[d]!==
void 0){if(c!=null){let g=We(e[d]-e[c]);g<m&&(m=g,a=We(n(e[d],o,r,l)-n(e[c],o,r,l)))}c=d}}return a}function e0(e){e=e||qr;
let t=se(e.size,[.6,ve,1]),n=e.align||0,o=e.gap||0,r=e.radius;r=r==null?[0,0]:typeof r=="number"?[r,0]:r;let l=ne(r),a=1-
t[0],c=se(t[1],ve),d=se(t[2],1),m=se(e.disp,qr),g=se(e.each,v=>{}),{fill:_,stroke:x}=m;return(v,k,N,E)=>ho(v,k,(F,w,P,S,K,L,Z,G,X,W,A)=>{
let B=F.pxRound,C=n,q=o*ce,U=c*ce,oe=d*ce,H,ft;S.ori==0?[H,ft]=l(v,k):[ft,H]=l(v,k);let ke=S.dir*(S.ori==0?1:-1),le=S.ori==
0?gi:Sa,me=S.ori==0?g:(D,be,Ie,bo,Hn,nn,Un)=>{g(D,be,Ie,Hn,bo,Un,nn)},Q=se(v.bands,ga).find(D=>D.series[0]==k),V=Q!=null?
Q.dir:0,Re=F.fillTo(v,k,F.min,F.max,V),ot=B(Z(Re,K,A,X)),Me,fe,Ut,_t=W,Ne=B(F.width*ce),tn=!1,vn=null,Pt=null,Tn=null,go=null;
_!=null&&(Ne==0||x!=null)&&(tn=!0,vn=_.values(v,k,N,E),Pt=new Map,new Set(vn).forEach(D=>{D!=null&&Pt.set(D,new Path2D)}),
Ne>0&&(Tn=x.values(v,k,N,E),go=new Map,new Set(Tn).forEach(D=>{D!=null&&go.set(D,new Path2D)})));let{x0:vo,size:ar}=m;if(vo!=
null&&ar!=null){C=1,w=vo.values(v,k,N,E),vo.unit==2&&(w=w.map(Ie=>v.posToVal(G+Ie*W,S.key,!0)));let D=ar.values(v,k,N,E);
ar.unit==2?fe=D[0]*W:fe=L(D[0],S,W,G)-L(0,S,W,G),_t=tp(w,P,L,S,W,G,_t),Ut=_t-fe+q}else _t=tp(w,P,L,S,W,G,_t),Ut=_t*a+q,fe=
_t-Ut;Ut<1&&(Ut=0),Ne>=fe/2&&(Ne=0),Ut<5&&(B=cp);let Zr=Ut>0,Vn=_t-Ut-(Zr?Ne:0);fe=B(ra(Vn,oe,U)),Me=(C==0?fe/2:C==ke?0:
fe)-C*ke*((C==0?q/2:0)+(Zr?Ne/2:0));let rt={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},_o=tn?null:new Path2D,
_n=null;if(Q!=null)_n=v.data[Q.series[1]];else{let{y0:D,y1:be}=m;D!=null&&be!=null&&(P=be.values(v,k,N,E),_n=D.values(v,
k,N,E))}let zn=H*fe,J=ft*fe;for(let D=ke==1?N:E;D>=N&&D<=E;D+=ke){let be=P[D];if(be==null)continue;if(_n!=null){let pt=_n[D]??
0;if(be-pt==0)continue;ot=Z(pt,K,A,X)}let Ie=S.distr!=2||m!=null?w[D]:D,bo=L(Ie,S,W,G),Hn=Z(se(be,Re),K,A,X),nn=B(bo-Me),
Un=B(ct(Hn,ot)),bt=B(en(Hn,ot)),Ot=Un-bt;if(be!=null){let pt=be<0?J:zn,Wt=be<0?zn:J;tn?(Ne>0&&Tn[D]!=null&&le(go.get(Tn[D]),
nn,bt+Et(Ne/2),fe,ct(0,Ot-Ne),pt,Wt),vn[D]!=null&&le(Pt.get(vn[D]),nn,bt+Et(Ne/2),fe,ct(0,Ot-Ne),pt,Wt)):le(_o,nn,bt+Et(
Ne/2),fe,ct(0,Ot-Ne),pt,Wt),me(v,k,D,nn-Ne/2,bt,fe+Ne,Ot)}}return Ne>0?rt.stroke=tn?go:_o:tn||(rt._fill=F.width==0?F._fill:
F._stroke??F._fill,rt.width=0),rt.fill=tn?Pt:_o,rt})}function t0(e,t){let n=se(t?.alignGaps,0);return(o,r,l,a)=>ho(o,r,(c,d,m,g,_,x,v,k,N,E,F)=>{
[l,a]=ui(m,l,a);let w=c.pxRound,P=H=>w(x(H,g,E,k)),S=H=>w(v(H,_,F,N)),K,L,Z;g.ori==0?(K=mi,Z=lr,L=Rp):(K=hi,Z=ir,L=Ip);let G=g.
dir*(g.ori==0?1:-1),X=P(d[G==1?l:a]),W=X,A=[],B=[];for(let H=G==1?l:a;H>=l&&H<=a;H+=G)if(m[H]!=null){let ke=d[H],le=P(ke);
A.push(W=le),B.push(S(m[H]))}let C={stroke:e(A,B,K,Z,L,w),fill:null,clip:null,band:null,gaps:null,flags:or},q=C.stroke,[
U,oe]=wa(o,r);if(c.fill!=null||U!=0){let H=C.fill=new Path2D(q),ft=c.fillTo(o,r,c.min,c.max,U),ke=S(ft);Z(H,W,ke),Z(H,X,
ke)}if(!c.spanGaps){let H=[];H.push(...ya(d,m,l,a,G,P,n)),C.gaps=H=c.gaps(o,r,l,a,H),C.clip=di(H,g.ori,k,N,E,F)}return oe!=
0&&(C.band=oe==2?[kn(o,r,l,a,q,-1),kn(o,r,l,a,q,1)]:kn(o,r,l,a,q,oe)),C})}function n0(e){return t0(o0,e)}function o0(e,t,n,o,r,l){
let a=e.length;if(a<2)return null;let c=new Path2D;if(n(c,e[0],t[0]),a==2)o(c,e[1],t[1]);else{let d=Array(a),m=Array(a-1),
g=Array(a-1),_=Array(a-1);for(let x=0;x<a-1;x++)g[x]=t[x+1]-t[x],_[x]=e[x+1]-e[x],m[x]=g[x]/_[x];d[0]=m[0];for(let x=1;x<
a-1;x++)m[x]===0||m[x-1]===0||m[x-1]>0!=m[x]>0?d[x]=0:(d[x]=3*(_[x-1]+_[x])/((2*_[x]+_[x-1])/m[x-1]+(_[x]+2*_[x-1])/m[x]),
isFinite(d[x])||(d[x]=0));d[a-1]=m[a-2];for(let x=0;x<a-1;x++)r(c,e[x]+_[x]/3,t[x]+d[x]*_[x]/3,e[x+1]-_[x]/3,t[x+1]-d[x+
1]*_[x]/3,e[x+1],t[x+1])}return c}var aa=new Set;function np(){for(let e of aa)e.syncRect(!0)}rr&&(po(Rg,Qo,np),po(Ig,Qo,
np,!0),po(ii,Qo,()=>{Ze.pxRatio=ce}));var r0=Hp(),l0=Vp();function op(e,t,n,o){return(o?[e[0],e[1]].concat(e.slice(2)):[
e[0]].concat(e.slice(1))).map((l,a)=>ua(l,a,t,n))}function i0(e,t){return e.map((n,o)=>o==0?{}:Le({},t,n))}function ua(e,t,n,o){
return Le({},t==0?n:o,e)}function Up(e,t,n){return t==null?tr:[t,n]}var s0=Up;function a0(e,t,n){return t==null?tr:si(t,
n,ma,!0)}function Wp(e,t,n,o){return t==null?tr:ci(t,n,e.scales[o].log,!1)}var u0=Wp;function Gp(e,t,n,o){return t==null?
tr:da(t,n,e.scales[o].log,!1)}var c0=Gp;function f0(e,t,n,o,r){let l=ct(Df(e),Df(t)),a=t-e,c=Qt(r/o*a,n);do{let d=n[c],m=o*
d/a;if(m>=r&&l+(d<5?In.get(d):0)<=17)return[d,m]}while(++c<n.length);return[0,0]}function rp(e){let t,n;return e=e.replace(
/(\d+)px/,(o,r)=>(t=Ue((n=+r)*ce))+"px"),[e,t,n]}function p0(e){e.show&&[e.font,e.labelFont].forEach(t=>{let n=_e(t[2]*ce,
1);t[0]=t[0].replace(/[0-9.]+px/,n+"px"),t[1]=n})}function Ze(e,t,n){let o={mode:se(e.mode,1)},r=o.mode;function l(s,u,f,p){
let h=u.valToPct(s);return p+f*(u.dir==-1?1-h:h)}function a(s,u,f,p){let h=u.valToPct(s);return p+f*(u.dir==-1?h:1-h)}function c(s,u,f,p){
return u.ori==0?l(s,u,f,p):a(s,u,f,p)}o.valToPosH=l,o.valToPosV=a;let d=!1;o.status=0;let m=o.root=Vt(bg);if(e.id!=null&&
(m.id=e.id),At(m,e.class),e.title){let s=Vt(yg,m);s.textContent=e.title}let g=Xt("canvas"),_=o.ctx=g.getContext("2d"),x=Vt(
Sg,m);po("click",x,s=>{s.target===k&&(xe!=Po||Te!=Oo)&&Xe.click(o,s)},!0);let v=o.under=Vt(kg,x);x.appendChild(g);let k=o.
over=Vt(Mg,x);e=nr(e);let N=+se(e.pxAlign,1),E=ep(N);(e.plugins||[]).forEach(s=>{s.opts&&(e=s.opts(o,e)||e)});let F=e.ms||
.001,w=o.series=r==1?op(e.series||[],qf,Xf,!1):i0(e.series||[null],Jf),P=o.axes=op(e.axes||[],jf,Kf,!0),S=o.scales={},K=o.
bands=e.bands||[];K.forEach(s=>{s.fill=ne(s.fill||null),s.dir=se(s.dir,-1)});let L=r==2?w[1].facets[0].scale:w[0].scale,
Z={axes:kd,series:bd},G=(e.drawOrder||["axes","series"]).map(s=>Z[s]);function X(s){let u=s.distr==3?f=>Sn(f>0?f:s.clamp(
o,f,s.min,s.max,s.key)):s.distr==4?f=>Zs(f,s.asinh):s.distr==100?f=>s.fwd(f):f=>f;return f=>{let p=u(f),{_min:h,_max:b}=s,
y=b-h;return(p-h)/y}}function W(s){let u=S[s];if(u==null){let f=(e.scales||qr)[s]||qr;if(f.from!=null){W(f.from);let p=Le(
{},S[f.from],f,{key:s});p.valToPct=X(p),S[s]=p}else{u=S[s]=Le({},s==L?Fp:Yv,f),u.key=s;let p=u.time,h=u.range,b=Rn(h);if((s!=
L||r==2&&!p)&&(b&&(h[0]==null||h[1]==null)&&(h={min:h[0]==null?Ff:{mode:1,hard:h[0],soft:h[0]},max:h[1]==null?Ff:{mode:1,
hard:h[1],soft:h[1]}},b=!1),!b&&pi(h))){let y=h;h=(M,T,O)=>T==null?tr:si(T,O,y)}u.range=ne(h||(p?s0:s==L?u.distr==3?u0:u.
distr==4?c0:Up:u.distr==3?Wp:u.distr==4?Gp:a0)),u.auto=ne(b?!1:u.auto),u.clamp=ne(u.clamp||qv),u._min=u._max=null,u.valToPct=
X(u)}}}W("x"),W("y"),r==1&&w.forEach(s=>{W(s.scale)}),P.forEach(s=>{W(s.scale)});for(let s in e.scales)W(s);let A=S[L],B=A.
distr,C,q;A.ori==0?(At(m,xg),C=l,q=a):(At(m,wg),C=a,q=l);let U={};for(let s in S){let u=S[s];(u.min!=null||u.max!=null)&&
(U[s]={min:u.min,max:u.max},u.min=u.max=null)}let oe=e.tzDate||(s=>new Date(Ue(s/F))),H=e.fmtDate||va,ft=F==1?xv(oe):Sv(
oe),ke=Wf(oe,Uf(F==1?bv:yv,H)),le=Bf(oe,Gf(Mv,H)),me=[],Q=o.legend=Le({},Ev,e.legend),V=o.cursor=Le({},$v,{drag:{y:r==2}},
e.cursor),Re=Q.show,ot=V.show,Me=Q.markers;Q.idxs=me,Me.width=ne(Me.width),Me.dash=ne(Me.dash),Me.stroke=ne(Me.stroke),Me.
fill=ne(Me.fill);let fe,Ut,_t,Ne=[],tn=[],vn,Pt=!1,Tn={};if(Q.live){let s=w[1]?w[1].values:null;Pt=s!=null,vn=Pt?s(o,1,0):
{_:0};for(let u in vn)Tn[u]=fa}if(Re)if(fe=Xt("table",Og,m),_t=Xt("tbody",null,fe),Q.mount(o,fe),Pt){Ut=Xt("thead",null,
fe,_t);let s=Xt("tr",null,Ut);Xt("th",null,s);for(var go in vn)Xt("th",bf,s).textContent=go}else At(fe,Cg),Q.live&&At(fe,
Fg);let vo={show:!0},ar={show:!1};function Zr(s,u){if(u==0&&(Pt||!Q.live||r==2))return tr;let f=[],p=Xt("tr",$g,_t,_t.childNodes[u]);
At(p,s.class),s.show||At(p,fo);let h=Xt("th",null,p);if(Me.show){let M=Vt(Dg,h);if(u>0){let T=Me.width(o,u);T&&(M.style.
border=T+"px "+Me.dash(o,u)+" "+Me.stroke(o,u)),M.style.background=Me.fill(o,u)}}let b=Vt(bf,h);s.label instanceof HTMLElement?
b.appendChild(s.label):b.textContent=s.label,u>0&&(Me.show||(b.style.color=s.width>0?Me.stroke(o,u):Me.fill(o,u)),rt("cl\
ick",h,M=>{if(V._lock)return;Gn(M);let T=w.indexOf(s);if((M.ctrlKey||M.metaKey)!=Q.isolate){let O=w.some(($,R)=>R>0&&R!=
T&&$.show);w.forEach(($,R)=>{R>0&&rn(R,O?R==T?vo:ar:vo,!0,Ce.setSeries)})}else rn(T,{show:!s.show},!0,Ce.setSeries)},!1),
wo&&rt(Sf,h,M=>{V._lock||(Gn(M),rn(w.indexOf(s),Co,!0,Ce.setSeries))},!1));for(var y in vn){let M=Xt("td",Lg,p);M.textContent=
"--",f.push(M)}return[p,f]}let Vn=new Map;function rt(s,u,f,p=!0){let h=Vn.get(u)||{},b=V.bind[s](o,u,f,p);b&&(po(s,u,h[s]=
b),Vn.set(u,h))}function _o(s,u,f){let p=Vn.get(u)||{};for(let h in p)(s==null||h==s)&&(oa(h,u,p[h]),delete p[h]);s==null&&
Vn.delete(u)}let _n=0,zn=0,J=0,D=0,be=0,Ie=0,bo=be,Hn=Ie,nn=J,Un=D,bt=0,Ot=0,pt=0,Wt=0;o.bbox={};let wi=!1,Jr=!1,xo=!1,Wn=!1,
Xr=!1,Ft=!1;function yi(s,u,f){(f||s!=o.width||u!=o.height)&&Oa(s,u),To(!1),xo=!0,Jr=!0,Ao()}function Oa(s,u){o.width=_n=
J=s,o.height=zn=D=u,be=Ie=0,pd(),dd();let f=o.bbox;bt=f.left=uo(be*ce,.5),Ot=f.top=uo(Ie*ce,.5),pt=f.width=uo(J*ce,.5),Wt=
f.height=uo(D*ce,.5)}let ud=3;function cd(){let s=!1,u=0;for(;!s;){u++;let f=yd(u),p=Sd(u);s=u==ud||f&&p,s||(Oa(o.width,
o.height),Jr=!0)}}function fd({width:s,height:u}){yi(s,u)}o.setSize=fd;function pd(){let s=!1,u=!1,f=!1,p=!1;P.forEach((h,b)=>{
if(h.show&&h._show){let{side:y,_size:M}=h,T=y%2,O=h.label!=null?h.labelSize:0,$=M+O;$>0&&(T?(J-=$,y==3?(be+=$,p=!0):f=!0):
(D-=$,y==0?(Ie+=$,s=!0):u=!0))}}),Bn[0]=s,Bn[1]=f,Bn[2]=u,Bn[3]=p,J-=An[1]+An[3],be+=An[3],D-=An[2]+An[0],Ie+=An[0]}function dd(){
let s=be+J,u=Ie+D,f=be,p=Ie;function h(b,y){switch(b){case 1:return s+=y,s-y;case 2:return u+=y,u-y;case 3:return f-=y,f+
y;case 0:return p-=y,p+y}}P.forEach((b,y)=>{if(b.show&&b._show){let M=b.side;b._pos=h(M,b._size),b.label!=null&&(b._lpos=
h(M,b.labelSize))}})}if(V.dataIdx==null){let s=V.hover,u=s.skip=new Set(s.skip??[]);u.add(void 0);let f=s.prox=ne(s.prox),
p=s.bias??=0;V.dataIdx=(h,b,y,M)=>{if(b==0)return y;let T=y,O=f(h,b,y,M)??ve,$=O>=0&&O<ve,R=A.ori==0?J:D,Y=V.left,ae=t[0],
ie=t[b];if(u.has(ie[y])){T=null;let ee=null,j=null,z;if(p==0||p==-1)for(z=y;ee==null&&z-- >0;)u.has(ie[z])||(ee=z);if(p==
0||p==1)for(z=y;j==null&&z++<ie.length;)u.has(ie[z])||(j=z);if(ee!=null||j!=null)if($){let ye=ee==null?-1/0:C(ae[ee],A,R,
0),Pe=j==null?1/0:C(ae[j],A,R,0),Ke=Y-ye,he=Pe-Y;Ke<=he?Ke<=O&&(T=ee):he<=O&&(T=j)}else T=j==null?ee:ee==null?j:y-ee<=j-
y?ee:j}else $&&We(Y-C(ae[y],A,R,0))>O&&(T=null);return T}}let Gn=s=>{V.event=s};V.idxs=me,V._lock=!1;let tt=V.points;tt.
show=ne(tt.show),tt.size=ne(tt.size),tt.stroke=ne(tt.stroke),tt.width=ne(tt.width),tt.fill=ne(tt.fill);let on=o.focus=Le(
{},e.focus||{alpha:.3},V.focus),wo=on.prox>=0,yo=wo&&tt.one,Ct=[],So=[],ko=[];function Fa(s,u){let f=tt.show(o,u);if(f instanceof
HTMLElement)return At(f,Pg),At(f,s.class),gn(f,-10,-10,J,D),k.insertBefore(f,Ct[u]),f}function Ca(s,u){if(r==1||u>0){let f=r==
1&&S[s.scale].time,p=s.value;s.value=f?If(p)?Bf(oe,Gf(p,H)):p||le:p||Gv,s.label=s.label||(f?Lv:Dv)}if(yo||u>0){s.width=s.
width==null?1:s.width,s.paths=s.paths||r0||Yg,s.fillTo=ne(s.fillTo||Kv),s.pxAlign=+se(s.pxAlign,N),s.pxRound=ep(s.pxAlign),
s.stroke=ne(s.stroke||null),s.fill=ne(s.fill||null),s._stroke=s._fill=s._paths=s._focus=null;let f=Bv(ct(1,s.width),1),p=s.
points=Le({},{size:f,width:ct(1,f*.2),stroke:s.stroke,space:f*2,paths:l0,_stroke:null,_fill:null},s.points);p.show=ne(p.
show),p.filter=ne(p.filter),p.fill=ne(p.fill),p.stroke=ne(p.stroke),p.paths=ne(p.paths),p.pxAlign=s.pxAlign}if(Re){let f=Zr(
s,u);Ne.splice(u,0,f[0]),tn.splice(u,0,f[1]),Q.values.push(null)}if(ot){me.splice(u,0,null);let f=null;yo?u==0&&(f=Fa(s,
u)):u>0&&(f=Fa(s,u)),Ct.splice(u,0,f),So.splice(u,0,0),ko.splice(u,0,0)}Ye("addSeries",u)}function md(s,u){u=u??w.length,
s=r==1?ua(s,u,qf,Xf):ua(s,u,{},Jf),w.splice(u,0,s),Ca(w[u],u)}o.addSeries=md;function hd(s){if(w.splice(s,1),Re){Q.values.
splice(s,1),tn.splice(s,1);let u=Ne.splice(s,1)[0];_o(null,u.firstChild),u.remove()}ot&&(me.splice(s,1),Ct.splice(s,1)[0].
remove(),So.splice(s,1),ko.splice(s,1)),Ye("delSeries",s)}o.delSeries=hd;let Bn=[!1,!1,!1,!1];function gd(s,u){if(s._show=
s.show,s.show){let f=s.side%2,p=S[s.scale];p==null&&(s.scale=f?w[1].scale:L,p=S[s.scale]);let h=p.time;s.size=ne(s.size),
s.space=ne(s.space),s.rotate=ne(s.rotate),Rn(s.incrs)&&s.incrs.forEach(y=>{!In.has(y)&&In.set(y,dp(y))}),s.incrs=ne(s.incrs||
(p.distr==2?gv:h?F==1?_v:wv:co)),s.splits=ne(s.splits||(h&&p.distr==1?ft:p.distr==3?la:p.distr==4?Vv:Iv)),s.stroke=ne(s.
stroke),s.grid.stroke=ne(s.grid.stroke),s.ticks.stroke=ne(s.ticks.stroke),s.border.stroke=ne(s.border.stroke);let b=s.values;
s.values=Rn(b)&&!Rn(b[0])?ne(b):h?Rn(b)?Wf(oe,Uf(b,H)):If(b)?kv(oe,b):b||ke:b||Rv,s.filter=ne(s.filter||(p.distr>=3&&p.log==
10?Uv:p.distr==3&&p.log==2?Wv:fp)),s.font=rp(s.font),s.labelFont=rp(s.labelFont),s._size=s.size(o,null,u,0),s._space=s._rotate=
s._incrs=s._found=s._splits=s._values=null,s._size>0&&(Bn[u]=!0,s._el=Vt(Tg,x))}}function ur(s,u,f,p){let[h,b,y,M]=f,T=u%
2,O=0;return T==0&&(M||b)&&(O=u==0&&!h||u==2&&!y?Ue(jf.size/3):0),T==1&&(h||y)&&(O=u==1&&!b||u==3&&!M?Ue(Kf.size/2):0),O}
let $a=o.padding=(e.padding||[ur,ur,ur,ur]).map(s=>ne(se(s,ur))),An=o._padding=$a.map((s,u)=>s(o,u,Bn,0)),Je,Ge=null,Be=null,
Qr=r==1?w[0].idxs:null,Gt=null,cr=!1;function Da(s,u){if(t=s??[],o.data=o._data=t,r==2){Je=0;for(let f=1;f<w.length;f++)
Je+=t[f][0].length}else{t.length==0&&(o.data=o._data=t=[[]]),Gt=t[0],Je=Gt.length;let f=t;if(B==2){f=t.slice();let p=f[0]=
Array(Je);for(let h=0;h<Je;h++)p[h]=h}o._data=t=f}if(To(!0),Ye("setData"),B==2&&(xo=!0),u!==!1){let f=A;f.auto(o,cr)?Si():
Nn(L,f.min,f.max),Wn=Wn||V.left>=0,Ft=!0,Ao()}}o.setData=Da;function Si(){cr=!0;let s,u;r==1&&(Je>0?(Ge=Qr[0]=0,Be=Qr[1]=
Je-1,s=t[0][Ge],u=t[0][Be],B==2?(s=Ge,u=Be):s==u&&(B==3?[s,u]=ci(s,s,A.log,!1):B==4?[s,u]=da(s,s,A.log,!1):A.time?u=s+Ue(
86400/F):[s,u]=si(s,u,ma,!0))):(Ge=Qr[0]=s=null,Be=Qr[1]=u=null)),Nn(L,s,u)}let el,Mo,ki,Mi,Ti,Ai,Ei,Ni,Pi,dt;function La(s,u,f,p,h,b){
s??=wf,f??=ga,p??="butt",h??=wf,b??="round",s!=el&&(_.strokeStyle=el=s),h!=Mo&&(_.fillStyle=Mo=h),u!=ki&&(_.lineWidth=ki=
u),b!=Ti&&(_.lineJoin=Ti=b),p!=Ai&&(_.lineCap=Ai=p),f!=Mi&&_.setLineDash(Mi=f)}function Ra(s,u,f,p){u!=Mo&&(_.fillStyle=
Mo=u),s!=Ei&&(_.font=Ei=s),f!=Ni&&(_.textAlign=Ni=f),p!=Pi&&(_.textBaseline=Pi=p)}function Oi(s,u,f,p,h=0){if(p.length>0&&
s.auto(o,cr)&&(u==null||u.min==null)){let b=se(Ge,0),y=se(Be,p.length-1),M=f.min==null?Ug(p,b,y,h,s.distr==3):[f.min,f.max];
s.min=en(s.min,f.min=M[0]),s.max=ct(s.max,f.max=M[1])}}let Ia={min:null,max:null};function vd(){for(let p in S){let h=S[p];
U[p]==null&&(h.min==null||U[L]!=null&&h.auto(o,cr))&&(U[p]=Ia)}for(let p in S){let h=S[p];U[p]==null&&h.from!=null&&U[h.
from]!=null&&(U[p]=Ia)}U[L]!=null&&To(!0);let s={};for(let p in U){let h=U[p];if(h!=null){let b=s[p]=nr(S[p],Jg);if(h.min!=
null)Le(b,h);else if(p!=L||r==2)if(Je==0&&b.from==null){let y=b.range(o,null,null,p);b.min=y[0],b.max=y[1]}else b.min=ve,
b.max=-ve}}if(Je>0){w.forEach((p,h)=>{if(r==1){let b=p.scale,y=U[b];if(y==null)return;let M=s[b];if(h==0){let T=M.range(
o,M.min,M.max,b);M.min=T[0],M.max=T[1],Ge=Qt(M.min,t[0]),Be=Qt(M.max,t[0]),Be-Ge>1&&(t[0][Ge]<M.min&&Ge++,t[0][Be]>M.max&&
Be--),p.min=Gt[Ge],p.max=Gt[Be]}else p.show&&p.auto&&Oi(M,y,p,t[h],p.sorted);p.idxs[0]=Ge,p.idxs[1]=Be}else if(h>0&&p.show&&
p.auto){let[b,y]=p.facets,M=b.scale,T=y.scale,[O,$]=t[h],R=s[M],Y=s[T];R!=null&&Oi(R,U[M],b,O,b.sorted),Y!=null&&Oi(Y,U[T],
y,$,y.sorted),p.min=y.min,p.max=y.max}});for(let p in s){let h=s[p],b=U[p];if(h.from==null&&(b==null||b.min==null)){let y=h.
range(o,h.min==ve?null:h.min,h.max==-ve?null:h.max,p);h.min=y[0],h.max=y[1]}}}for(let p in s){let h=s[p];if(h.from!=null){
let b=s[h.from];if(b.min==null)h.min=h.max=null;else{let y=h.range(o,b.min,b.max,p);h.min=y[0],h.max=y[1]}}}let u={},f=!1;
for(let p in s){let h=s[p],b=S[p];if(b.min!=h.min||b.max!=h.max){b.min=h.min,b.max=h.max;let y=b.distr;b._min=y==3?Sn(b.
min):y==4?Zs(b.min,b.asinh):y==100?b.fwd(b.min):b.min,b._max=y==3?Sn(b.max):y==4?Zs(b.max,b.asinh):y==100?b.fwd(b.max):b.
max,u[p]=f=!0}}if(f){w.forEach((p,h)=>{r==2?h>0&&u.y&&(p._paths=null):u[p.scale]&&(p._paths=null)});for(let p in u)xo=!0,
Ye("setScale",p);ot&&V.left>=0&&(Wn=Ft=!0)}for(let p in U)U[p]=null}function _d(s){let u=ra(Ge-1,0,Je-1),f=ra(Be+1,0,Je-
1);for(;s[u]==null&&u>0;)u--;for(;s[f]==null&&f<Je-1;)f++;return[u,f]}function bd(){if(Je>0){let s=w.some(u=>u._focus)&&
dt!=on.alpha;s&&(_.globalAlpha=dt=on.alpha),w.forEach((u,f)=>{if(f>0&&u.show&&(Va(f,!1),Va(f,!0),u._paths==null)){let p=dt;
dt!=u.alpha&&(_.globalAlpha=dt=u.alpha);let h=r==2?[0,t[f][0].length-1]:_d(t[f]);u._paths=u.paths(o,f,h[0],h[1]),dt!=p&&
(_.globalAlpha=dt=p)}}),w.forEach((u,f)=>{if(f>0&&u.show){let p=dt;dt!=u.alpha&&(_.globalAlpha=dt=u.alpha),u._paths!=null&&
za(f,!1);{let h=u._paths!=null?u._paths.gaps:null,b=u.points.show(o,f,Ge,Be,h),y=u.points.filter(o,f,b,h);(b||y)&&(u.points.
_paths=u.points.paths(o,f,Ge,Be,y),za(f,!0))}dt!=p&&(_.globalAlpha=dt=p),Ye("drawSeries",f)}}),s&&(_.globalAlpha=dt=1)}}
function Va(s,u){let f=u?w[s].points:w[s];f._stroke=f.stroke(o,s),f._fill=f.fill(o,s)}function za(s,u){let f=u?w[s].points:
w[s],{stroke:p,fill:h,clip:b,flags:y,_stroke:M=f._stroke,_fill:T=f._fill,_width:O=f.width}=f._paths;O=_e(O*ce,3);let $=null,
R=O%2/2;u&&T==null&&(T=O>0?"#fff":M);let Y=f.pxAlign==1&&R>0;if(Y&&_.translate(R,R),!u){let ae=bt-O/2,ie=Ot-O/2,ee=pt+O,
j=Wt+O;$=new Path2D,$.rect(ae,ie,ee,j)}u?Fi(M,O,f.dash,f.cap,T,p,h,y,b):xd(s,M,O,f.dash,f.cap,T,p,h,y,$,b),Y&&_.translate(
-R,-R)}function xd(s,u,f,p,h,b,y,M,T,O,$){let R=!1;T!=0&&K.forEach((Y,ae)=>{if(Y.series[0]==s){let ie=w[Y.series[1]],ee=t[Y.
series[1]],j=(ie._paths||qr).band;Rn(j)&&(j=Y.dir==1?j[0]:j[1]);let z,ye=null;ie.show&&j&&Gg(ee,Ge,Be)?(ye=Y.fill(o,ae)||
b,z=ie._paths.clip):j=null,Fi(u,f,p,h,ye,y,M,T,O,$,z,j),R=!0}}),R||Fi(u,f,p,h,b,y,M,T,O,$)}let Ha=or|sa;function Fi(s,u,f,p,h,b,y,M,T,O,$,R){
La(s,u,f,p,h),(T||O||R)&&(_.save(),T&&_.clip(T),O&&_.clip(O)),R?(M&Ha)==Ha?(_.clip(R),$&&_.clip($),nl(h,y),tl(s,b,u)):M&
sa?(nl(h,y),_.clip(R),tl(s,b,u)):M&or&&(_.save(),_.clip(R),$&&_.clip($),nl(h,y),_.restore(),tl(s,b,u)):(nl(h,y),tl(s,b,u)),
(T||O||R)&&_.restore()}function tl(s,u,f){f>0&&(u instanceof Map?u.forEach((p,h)=>{_.strokeStyle=el=h,_.stroke(p)}):u!=null&&
s&&_.stroke(u))}function nl(s,u){u instanceof Map?u.forEach((f,p)=>{_.fillStyle=Mo=p,_.fill(f)}):u!=null&&s&&_.fill(u)}function wd(s,u,f,p){
let h=P[s],b;if(p<=0)b=[0,0];else{let y=h._space=h.space(o,s,u,f,p),M=h._incrs=h.incrs(o,s,u,f,p,y);b=f0(u,f,M,p,y)}return h.
_found=b}function Ci(s,u,f,p,h,b,y,M,T,O){let $=y%2/2;N==1&&_.translate($,$),La(M,y,T,O,M),_.beginPath();let R,Y,ae,ie,ee=h+
(p==0||p==3?-b:b);f==0?(Y=h,ie=ee):(R=h,ae=ee);for(let j=0;j<s.length;j++)u[j]!=null&&(f==0?R=ae=s[j]:Y=ie=s[j],_.moveTo(
R,Y),_.lineTo(ae,ie));_.stroke(),N==1&&_.translate(-$,-$)}function yd(s){let u=!0;return P.forEach((f,p)=>{if(!f.show)return;
let h=S[f.scale];if(h.min==null){f._show&&(u=!1,f._show=!1,To(!1));return}else f._show||(u=!1,f._show=!0,To(!1));let b=f.
side,y=b%2,{min:M,max:T}=h,[O,$]=wd(p,M,T,y==0?J:D);if($==0)return;let R=h.distr==2,Y=f._splits=f.splits(o,p,M,T,O,$,R),
ae=h.distr==2?Y.map(z=>Gt[z]):Y,ie=h.distr==2?Gt[Y[1]]-Gt[Y[0]]:O,ee=f._values=f.values(o,f.filter(o,ae,p,$,ie),p,$,ie);
f._rotate=b==2?f.rotate(o,ee,p,$):0;let j=f._size;f._size=zt(f.size(o,ee,p,s)),j!=null&&f._size!=j&&(u=!1)}),u}function Sd(s){
let u=!0;return $a.forEach((f,p)=>{let h=f(o,p,Bn,s);h!=An[p]&&(u=!1),An[p]=h}),u}function kd(){for(let s=0;s<P.length;s++){
let u=P[s];if(!u.show||!u._show)continue;let f=u.side,p=f%2,h,b,y=u.stroke(o,s),M=f==0||f==3?-1:1,[T,O]=u._found;if(u.label!=
null){let it=u.labelGap*M,yt=Ue((u._lpos+it)*ce);Ra(u.labelFont[0],y,"center",f==2?"top":xf),_.save(),p==1?(h=b=0,_.translate(
yt,Ue(Ot+Wt/2)),_.rotate((f==3?-li:li)/2)):(h=Ue(bt+pt/2),b=yt);let Yn=up(u.label)?u.label(o,s,T,O):u.label;_.fillText(Yn,
h,b),_.restore()}if(O==0)continue;let $=S[u.scale],R=p==0?pt:Wt,Y=p==0?bt:Ot,ae=u._splits,ie=$.distr==2?ae.map(it=>Gt[it]):
ae,ee=$.distr==2?Gt[ae[1]]-Gt[ae[0]]:T,j=u.ticks,z=u.border,ye=j.show?j.size:0,Pe=Ue(ye*ce),Ke=Ue((u.alignTo==2?u._size-
ye-u.gap:u.gap)*ce),he=u._rotate*-li/180,Oe=E(u._pos*ce),xt=(Pe+Ke)*M,lt=Oe+xt;b=p==0?lt:0,h=p==1?lt:0;let $t=u.font[0],
Bt=u.align==1?Jo:u.align==2?qs:he>0?Jo:he<0?qs:p==0?"center":f==3?qs:Jo,sn=he||p==1?"middle":f==2?"top":xf;Ra($t,y,Bt,sn);
let wt=u.font[1]*u.lineGap,Dt=ae.map(it=>E(c(it,$,R,Y))),jt=u._values;for(let it=0;it<jt.length;it++){let yt=jt[it];if(yt!=
null){p==0?h=Dt[it]:b=Dt[it],yt=""+yt;let Yn=yt.indexOf(`
`)==-1?[yt]:yt.split(/\n/gm);for(let st=0;st<Yn.length;st++){let iu=Yn[st];he?(_.save(),_.translate(h,b+st*wt),_.rotate(
he),_.fillText(iu,0,0),_.restore()):_.fillText(iu,h,b+st*wt)}}}j.show&&Ci(Dt,j.filter(o,ie,s,O,ee),p,f,Oe,Pe,_e(j.width*
ce,3),j.stroke(o,s),j.dash,j.cap);let an=u.grid;an.show&&Ci(Dt,an.filter(o,ie,s,O,ee),p,p==0?2:1,p==0?Ot:bt,p==0?Wt:pt,_e(
an.width*ce,3),an.stroke(o,s),an.dash,an.cap),z.show&&Ci([Oe],[1],p==0?1:0,p==0?1:2,p==1?Ot:bt,p==1?Wt:pt,_e(z.width*ce,
3),z.stroke(o,s),z.dash,z.cap)}Ye("drawAxes")}function To(s){w.forEach((u,f)=>{f>0&&(u._paths=null,s&&(r==1?(u.min=null,
u.max=null):u.facets.forEach(p=>{p.min=null,p.max=null})))})}let ol=!1,$i=!1,fr=[];function Md(){$i=!1;for(let s=0;s<fr.
length;s++)Ye(...fr[s]);fr.length=0}function Ao(){ol||(rv(Ua),ol=!0)}function Td(s,u=!1){ol=!0,$i=u,s(o),Ua(),u&&fr.length>
0&&queueMicrotask(Md)}o.batch=Td;function Ua(){if(wi&&(vd(),wi=!1),xo&&(cd(),xo=!1),Jr){if(Se(v,Jo,be),Se(v,"top",Ie),Se(
v,Wr,J),Se(v,Gr,D),Se(k,Jo,be),Se(k,"top",Ie),Se(k,Wr,J),Se(k,Gr,D),Se(x,Wr,_n),Se(x,Gr,zn),g.width=Ue(_n*ce),g.height=Ue(
zn*ce),P.forEach(({_el:s,_show:u,_size:f,_pos:p,side:h})=>{if(s!=null)if(u){let b=h===3||h===0?f:0,y=h%2==1;Se(s,y?"left":
"top",p-b),Se(s,y?"width":"height",f),Se(s,y?"top":"left",y?Ie:be),Se(s,y?"height":"width",y?D:J),na(s,fo)}else At(s,fo)}),
el=Mo=ki=Ti=Ai=Ei=Ni=Pi=Mi=null,dt=1,mr(!0),be!=bo||Ie!=Hn||J!=nn||D!=Un){To(!1);let s=J/nn,u=D/Un;if(ot&&!Wn&&V.left>=0){
V.left*=s,V.top*=u,Eo&&gn(Eo,Ue(V.left),0,J,D),No&&gn(No,0,Ue(V.top),J,D);for(let f=0;f<Ct.length;f++){let p=Ct[f];p!=null&&
(So[f]*=s,ko[f]*=u,gn(p,zt(So[f]),zt(ko[f]),J,D))}}if(we.show&&!Xr&&we.left>=0&&we.width>0){we.left*=s,we.width*=s,we.top*=
u,we.height*=u;for(let f in zi)Se(Fo,f,we[f])}bo=be,Hn=Ie,nn=J,Un=D}Ye("setSize"),Jr=!1}_n>0&&zn>0&&(_.clearRect(0,0,g.width,
g.height),Ye("drawClear"),G.forEach(s=>s()),Ye("draw")),we.show&&Xr&&(rl(we),Xr=!1),ot&&Wn&&(qn(null,!0,!1),Wn=!1),Q.show&&
Q.live&&Ft&&(Ii(),Ft=!1),d||(d=!0,o.status=1,Ye("ready")),cr=!1,ol=!1}o.redraw=(s,u)=>{xo=u||!1,s!==!1?Nn(L,A.min,A.max):
Ao()};function Di(s,u){let f=S[s];if(f.from==null){if(Je==0){let p=f.range(o,u.min,u.max,s);u.min=p[0],u.max=p[1]}if(u.min>
u.max){let p=u.min;u.min=u.max,u.max=p}if(Je>1&&u.min!=null&&u.max!=null&&u.max-u.min<1e-16)return;s==L&&f.distr==2&&Je>
0&&(u.min=Qt(u.min,t[0]),u.max=Qt(u.max,t[0]),u.min==u.max&&u.max++),U[s]=u,wi=!0,Ao()}}o.setScale=Di;let Li,Ri,Eo,No,Wa,
Ga,Po,Oo,Ba,ja,xe,Te,En=!1,Xe=V.drag,je=Xe.x,qe=Xe.y;ot&&(V.x&&(Li=Vt(Eg,k)),V.y&&(Ri=Vt(Ng,k)),A.ori==0?(Eo=Li,No=Ri):(Eo=
Ri,No=Li),xe=V.left,Te=V.top);let we=o.select=Le({show:!0,over:!0,left:0,width:0,top:0,height:0},e.select),Fo=we.show?Vt(
Ag,we.over?k:v):null;function rl(s,u){if(we.show){for(let f in s)we[f]=s[f],f in zi&&Se(Fo,f,s[f]);u!==!1&&Ye("setSelect")}}
o.setSelect=rl;function Ad(s){if(w[s].show)Re&&na(Ne[s],fo);else if(Re&&At(Ne[s],fo),ot){let f=yo?Ct[0]:Ct[s];f!=null&&gn(
f,-10,-10,J,D)}}function Nn(s,u,f){Di(s,{min:u,max:f})}function rn(s,u,f,p){u.focus!=null&&Fd(s),u.show!=null&&w.forEach(
(h,b)=>{b>0&&(s==b||s==null)&&(h.show=u.show,Ad(b),r==2?(Nn(h.facets[0].scale,null,null),Nn(h.facets[1].scale,null,null)):
Nn(h.scale,null,null),Ao())}),f!==!1&&Ye("setSeries",s,u),p&&hr("setSeries",o,s,u)}o.setSeries=rn;function Ed(s,u){Le(K[s],
u)}function Nd(s,u){s.fill=ne(s.fill||null),s.dir=se(s.dir,-1),u=u??K.length,K.splice(u,0,s)}function Pd(s){s==null?K.length=
0:K.splice(s,1)}o.addBand=Nd,o.setBand=Ed,o.delBand=Pd;function Od(s,u){w[s].alpha=u,ot&&Ct[s]!=null&&(Ct[s].style.opacity=
u),Re&&Ne[s]&&(Ne[s].style.opacity=u)}let bn,Pn,jn,Co={focus:!0};function Fd(s){if(s!=jn){let u=s==null,f=on.alpha!=1;w.
forEach((p,h)=>{if(r==1||h>0){let b=u||h==0||h==s;p._focus=u?null:b,f&&Od(h,b?1:on.alpha)}}),jn=s,f&&Ao()}}Re&&wo&&rt(kf,
fe,s=>{V._lock||(Gn(s),jn!=null&&rn(null,Co,!0,Ce.setSeries))});function ln(s,u,f){let p=S[u];f&&(s=s/ce-(p.ori==1?Ie:be));
let h=J;p.ori==1&&(h=D,s=h-s),p.dir==-1&&(s=h-s);let b=p._min,y=p._max,M=s/h,T=b+(y-b)*M,O=p.distr;return O==3?er(10,T):
O==4?jg(T,p.asinh):O==100?p.bwd(T):T}function Cd(s,u){let f=ln(s,L,u);return Qt(f,t[0],Ge,Be)}o.valToIdx=s=>Qt(s,t[0]),o.
posToIdx=Cd,o.posToVal=ln,o.valToPos=(s,u,f)=>S[u].ori==0?l(s,S[u],f?pt:J,f?bt:0):a(s,S[u],f?Wt:D,f?Ot:0),o.setCursor=(s,u,f)=>{
xe=s.left,Te=s.top,qn(null,u,f)};function qa(s,u){Se(Fo,Jo,we.left=s),Se(Fo,Wr,we.width=u)}function Ya(s,u){Se(Fo,"top",
we.top=s),Se(Fo,Gr,we.height=u)}let pr=A.ori==0?qa:Ya,dr=A.ori==1?qa:Ya;function $d(){if(Re&&Q.live)for(let s=r==2?1:0;s<
w.length;s++){if(s==0&&Pt)continue;let u=Q.values[s],f=0;for(let p in u)tn[s][f++].firstChild.nodeValue=u[p]}}function Ii(s,u){
if(s!=null&&(s.idxs?s.idxs.forEach((f,p)=>{me[p]=f}):Zg(s.idx)||me.fill(s.idx),Q.idx=me[0]),Re&&Q.live){for(let f=0;f<w.
length;f++)(f>0||r==1&&!Pt)&&Dd(f,me[f]);$d()}Ft=!1,u!==!1&&Ye("setLegend")}o.setLegend=Ii;function Dd(s,u){let f=w[s],p=s==
0&&B==2?Gt:t[s],h;Pt?h=f.values(o,s,u)??Tn:(h=f.value(o,u==null?null:p[u],s,u),h=h==null?Tn:{_:h}),Q.values[s]=h}function qn(s,u,f){
Ba=xe,ja=Te,[xe,Te]=V.move(o,xe,Te),V.left=xe,V.top=Te,ot&&(Eo&&gn(Eo,Ue(xe),0,J,D),No&&gn(No,0,Ue(Te),J,D));let p,h=Ge>
Be;bn=ve,Pn=null;let b=A.ori==0?J:D,y=A.ori==1?J:D;if(xe<0||Je==0||h){p=V.idx=null;for(let M=0;M<w.length;M++){let T=Ct[M];
T!=null&&gn(T,-10,-10,J,D)}wo&&rn(null,Co,!0,s==null&&Ce.setSeries),Q.live&&(me.fill(p),Ft=!0)}else{let M,T,O;r==1&&(M=A.
ori==0?xe:Te,T=ln(M,L),p=V.idx=Qt(T,t[0],Ge,Be),O=C(t[0][p],A,b,0));let $=-10,R=-10,Y=0,ae=0,ie=!0,ee="",j="";for(let z=r==
2?1:0;z<w.length;z++){let ye=w[z],Pe=me[z],Ke=Pe==null?null:r==1?t[z][Pe]:t[z][1][Pe],he=V.dataIdx(o,z,p,T),Oe=he==null?
null:r==1?t[z][he]:t[z][1][he];if(Ft=Ft||Oe!=Ke||he!=Pe,me[z]=he,z>0&&ye.show){let xt=he==null?-10:he==p?O:C(r==1?t[0][he]:
t[z][0][he],A,b,0),lt=Oe==null?-10:q(Oe,r==1?S[ye.scale]:S[ye.facets[1].scale],y,0);if(wo&&Oe!=null){let $t=A.ori==1?xe:
Te,Bt=We(on.dist(o,z,he,lt,$t));if(Bt<bn){let sn=on.bias;if(sn!=0){let wt=ln($t,ye.scale),Dt=Oe>=0?1:-1,jt=wt>=0?1:-1;jt==
Dt&&(jt==1?sn==1?Oe>=wt:Oe<=wt:sn==1?Oe<=wt:Oe>=wt)&&(bn=Bt,Pn=z)}else bn=Bt,Pn=z}}if(Ft||yo){let $t,Bt;A.ori==0?($t=xt,
Bt=lt):($t=lt,Bt=xt);let sn,wt,Dt,jt,an,it,yt=!0,Yn=tt.bbox;if(Yn!=null){yt=!1;let st=Yn(o,z);Dt=st.left,jt=st.top,sn=st.
width,wt=st.height}else Dt=$t,jt=Bt,sn=wt=tt.size(o,z);if(it=tt.fill(o,z),an=tt.stroke(o,z),yo)z==Pn&&bn<=on.prox&&($=Dt,
R=jt,Y=sn,ae=wt,ie=yt,ee=it,j=an);else{let st=Ct[z];st!=null&&(So[z]=Dt,ko[z]=jt,Of(st,sn,wt,yt),Nf(st,it,an),gn(st,zt(Dt),
zt(jt),J,D))}}}}if(yo){let z=on.prox,ye=jn==null?bn<=z:bn>z||Pn!=jn;if(Ft||ye){let Pe=Ct[0];Pe!=null&&(So[0]=$,ko[0]=R,Of(
Pe,Y,ae,ie),Nf(Pe,ee,j),gn(Pe,zt($),zt(R),J,D))}}}if(we.show&&En)if(s!=null){let[M,T]=Ce.scales,[O,$]=Ce.match,[R,Y]=s.cursor.
sync.scales,ae=s.cursor.drag;if(je=ae._x,qe=ae._y,je||qe){let{left:ie,top:ee,width:j,height:z}=s.select,ye=s.scales[R].ori,
Pe=s.posToVal,Ke,he,Oe,xt,lt,$t=M!=null&&O(M,R),Bt=T!=null&&$(T,Y);$t&&je?(ye==0?(Ke=ie,he=j):(Ke=ee,he=z),Oe=S[M],xt=C(
Pe(Ke,R),Oe,b,0),lt=C(Pe(Ke+he,R),Oe,b,0),pr(en(xt,lt),We(lt-xt))):pr(0,b),Bt&&qe?(ye==1?(Ke=ie,he=j):(Ke=ee,he=z),Oe=S[T],
xt=q(Pe(Ke,Y),Oe,y,0),lt=q(Pe(Ke+he,Y),Oe,y,0),dr(en(xt,lt),We(lt-xt))):dr(0,y)}else Hi()}else{let M=We(Ba-Wa),T=We(ja-Ga);
if(A.ori==1){let Y=M;M=T,T=Y}je=Xe.x&&M>=Xe.dist,qe=Xe.y&&T>=Xe.dist;let O=Xe.uni;O!=null?je&&qe&&(je=M>=O,qe=T>=O,!je&&
!qe&&(T>M?qe=!0:je=!0)):Xe.x&&Xe.y&&(je||qe)&&(je=qe=!0);let $,R;je&&(A.ori==0?($=Po,R=xe):($=Oo,R=Te),pr(en($,R),We(R-$)),
qe||dr(0,y)),qe&&(A.ori==1?($=Po,R=xe):($=Oo,R=Te),dr(en($,R),We(R-$)),je||pr(0,b)),!je&&!qe&&(pr(0,0),dr(0,0))}if(Xe._x=
je,Xe._y=qe,s==null){if(f){if(lu!=null){let[M,T]=Ce.scales;Ce.values[0]=M!=null?ln(A.ori==0?xe:Te,M):null,Ce.values[1]=T!=
null?ln(A.ori==1?xe:Te,T):null}hr(Ys,o,xe,Te,J,D,p)}if(wo){let M=f&&Ce.setSeries,T=on.prox;jn==null?bn<=T&&rn(Pn,Co,!0,M):
bn>T?rn(null,Co,!0,M):Pn!=jn&&rn(Pn,Co,!0,M)}}Ft&&(Q.idx=p,Ii()),u!==!1&&Ye("setCursor")}let On=null;Object.defineProperty(
o,"rect",{get(){return On==null&&mr(!1),On}});function mr(s=!1){s?On=null:(On=k.getBoundingClientRect(),Ye("syncRect",On))}
function Ka(s,u,f,p,h,b,y){V._lock||En&&s!=null&&s.movementX==0&&s.movementY==0||(Vi(s,u,f,p,h,b,y,!1,s!=null),s!=null?qn(
null,!0,!0):qn(u,!0,!1))}function Vi(s,u,f,p,h,b,y,M,T){if(On==null&&mr(!1),Gn(s),s!=null)f=s.clientX-On.left,p=s.clientY-
On.top;else{if(f<0||p<0){xe=-10,Te=-10;return}let[O,$]=Ce.scales,R=u.cursor.sync,[Y,ae]=R.values,[ie,ee]=R.scales,[j,z]=Ce.
match,ye=u.axes[0].side%2==1,Pe=A.ori==0?J:D,Ke=A.ori==1?J:D,he=ye?b:h,Oe=ye?h:b,xt=ye?p:f,lt=ye?f:p;if(ie!=null?f=j(O,ie)?
c(Y,S[O],Pe,0):-10:f=Pe*(xt/he),ee!=null?p=z($,ee)?c(ae,S[$],Ke,0):-10:p=Ke*(lt/Oe),A.ori==1){let $t=f;f=p,p=$t}}T&&(u==
null||u.cursor.event.type==Ys)&&((f<=1||f>=J-1)&&(f=uo(f,J)),(p<=1||p>=D-1)&&(p=uo(p,D))),M?(Wa=f,Ga=p,[Po,Oo]=V.move(o,
f,p)):(xe=f,Te=p)}let zi={width:0,height:0,left:0,top:0};function Hi(){rl(zi,!1)}let Za,Ja,Xa,Qa;function eu(s,u,f,p,h,b,y){
En=!0,je=qe=Xe._x=Xe._y=!1,Vi(s,u,f,p,h,b,y,!0,!1),s!=null&&(rt(Ks,ea,tu,!1),hr(yf,o,Po,Oo,J,D,null));let{left:M,top:T,width:O,
height:$}=we;Za=M,Ja=T,Xa=O,Qa=$}function tu(s,u,f,p,h,b,y){En=Xe._x=Xe._y=!1,Vi(s,u,f,p,h,b,y,!1,!0);let{left:M,top:T,width:O,
height:$}=we,R=O>0||$>0,Y=Za!=M||Ja!=T||Xa!=O||Qa!=$;if(R&&Y&&rl(we),Xe.setScale&&R&&Y){let ae=M,ie=O,ee=T,j=$;if(A.ori==
1&&(ae=T,ie=$,ee=M,j=O),je&&Nn(L,ln(ae,L),ln(ae+ie,L)),qe)for(let z in S){let ye=S[z];z!=L&&ye.from==null&&ye.min!=ve&&Nn(
z,ln(ee+j,z),ln(ee,z))}Hi()}else V.lock&&(V._lock=!V._lock,qn(u,!0,s!=null));s!=null&&(_o(Ks,ea),hr(Ks,o,xe,Te,J,D,null))}
function Ld(s,u,f,p,h,b,y){if(V._lock)return;Gn(s);let M=En;if(En){let T=!0,O=!0,$=10,R,Y;A.ori==0?(R=je,Y=qe):(R=qe,Y=je),
R&&Y&&(T=xe<=$||xe>=J-$,O=Te<=$||Te>=D-$),R&&T&&(xe=xe<Po?0:J),Y&&O&&(Te=Te<Oo?0:D),qn(null,!0,!0),En=!1}xe=-10,Te=-10,me.
fill(null),qn(null,!0,!0),M&&(En=M)}function nu(s,u,f,p,h,b,y){V._lock||(Gn(s),Si(),Hi(),s!=null&&hr(Mf,o,xe,Te,J,D,null))}
function ou(){P.forEach(p0),yi(o.width,o.height,!0)}po(ii,Qo,ou);let $o={};$o.mousedown=eu,$o.mousemove=Ka,$o.mouseup=tu,
$o.dblclick=nu,$o.setSeries=(s,u,f,p)=>{let h=Ce.match[2];f=h(o,u,f),f!=-1&&rn(f,p,!0,!1)},ot&&(rt(yf,k,eu),rt(Ys,k,Ka),
rt(Sf,k,s=>{Gn(s),mr(!1)}),rt(kf,k,Ld),rt(Mf,k,nu),aa.add(o),o.syncRect=mr);let ll=o.hooks=e.hooks||{};function Ye(s,u,f){
$i?fr.push([s,u,f]):s in ll&&ll[s].forEach(p=>{p.call(null,o,u,f)})}(e.plugins||[]).forEach(s=>{for(let u in s.hooks)ll[u]=
(ll[u]||[]).concat(s.hooks[u])});let ru=(s,u,f)=>f,Ce=Le({key:null,setSeries:!1,filters:{pub:Lf,sub:Lf},scales:[L,w[1]?w[1].
scale:null],match:[Rf,Rf,ru],values:[null,null]},V.sync);Ce.match.length==2&&Ce.match.push(ru),V.sync=Ce;let lu=Ce.key,Ui=Cp(
lu);function hr(s,u,f,p,h,b,y){Ce.filters.pub(s,u,f,p,h,b,y)&&Ui.pub(s,u,f,p,h,b,y)}Ui.sub(o);function Rd(s,u,f,p,h,b,y){
Ce.filters.sub(s,u,f,p,h,b,y)&&$o[s](null,u,f,p,h,b,y)}o.pub=Rd;function Id(){Ui.unsub(o),aa.delete(o),Vn.clear(),oa(ii,
Qo,ou),m.remove(),fe?.remove(),Ye("destroy")}o.destroy=Id;function Wi(){Ye("init",e,t),Da(t||e.data,!1),U[L]?Di(L,U[L]):
Si(),Xr=we.show&&(we.width>0||we.height>0),Wn=Ft=!0,yi(e.width,e.height)}return w.forEach(Ca),P.forEach(gd),n?n instanceof
HTMLElement?(n.appendChild(m),Wi()):n(o,Wi):Wi(),o}Ze.assign=Le;Ze.fmtNum=ha;Ze.rangeNum=si;Ze.rangeLog=ci;Ze.rangeAsinh=
da;Ze.orient=ho;Ze.pxRatio=ce;Ze.join=ov;Ze.fmtDate=va,Ze.tzDate=mv;Ze.sync=Cp;{Ze.addGap=Zv,Ze.clipGaps=di;let e=Ze.paths=
{points:Vp};e.linear=Hp,e.stepped=Qv,e.bars=e0,e.spline=n0}var d0=8;function Bp(e){let t=[...e.touches].map(r=>r.clientX),n=Math.min(...t),o=Math.max(...t);return{fingers:t.length,
middle:(n+o)/2,spread:o-n}}function jp(e){let t=null;e.addEventListener("touchstart",n=>t=Bp(n),{passive:!0}),e.addEventListener(
"touchend",()=>t=null,{passive:!0}),e.addEventListener("touchmove",n=>{let o=Bp(n),{left:r,width:l}=e.getBoundingClientRect();
(!t||t.fingers!==o.fingers)&&(t=o),!(Math.abs(o.middle-t.middle)+Math.abs(o.spread-t.spread)<d0)&&(o.fingers>1&&o.spread>
0&&t.spread>0&&hn(t.spread/o.spread,(o.middle-r)/l),Hr((t.middle-o.middle)/l),t=o)},{passive:!0})}var Jp=220,qp=[[],[6,3],[2,2],[8,3,2,3]],Aa=8,vi=I(null),ka=e=>String(e).padStart(2,"0");function m0(e,t){let n=new Date(
e*1e3),o=`${ka(n.getHours())}:${ka(n.getMinutes())}:${ka(n.getSeconds())}`;return t?`${o}.${Math.floor(n.getMilliseconds()/
100)}`:o}var h0=(e,t,n,o,r)=>t.map(l=>m0(l,r<1));function Yp(e,t,n,o,r){let[l="",a="0"]=Number(r.toPrecision(3)).toExponential().
split("e"),c=Math.max(0,Math.min(9,l.replace(/\D/g,"").length-1-Number(a))),d=Math.max(...t.map(Math.abs));return t.map(
m=>d>=1e7?m.toExponential(2):m.toFixed(c))}var Ta=e=>e.axis===1,g0=56,Kr=new Map;function Kp(e,t,n){for(let r of Kr.keys())
r.root.isConnected||Kr.delete(r);let o=Kr.get(e)??[];return o[n]=Math.max(0,...(t??[]).map(r=>7*r.length+12)),Kr.set(e,o),
Math.max(g0,...[...Kr.values()].flat())}function v0(e,t){let n=ro("dim"),o={stroke:ro("line"),width:1},l={stroke:n,font:"\
11px system-ui, sans-serif",ticks:{...o,size:4},grid:o};return[{...l,values:h0,space:70,size:28},{...l,scale:"0",values:Yp,
size:Kp,space:32},{...l,scale:"1",values:t?Yp:()=>[],ticks:{...l.ticks,show:t},size:Kp,space:32,side:1,show:e,grid:{show:!1}}]}
function Zp(e,t,n){if(t===null||n===null||!Number.isFinite(t)||!Number.isFinite(n))return[0,1];let o=(n-t)*.08||Math.abs(
n)*.1||1;return[t-o,n+o]}function _0(e){return e.map((t,n)=>({label:t.formula,scale:String(t.axis),stroke:ro(`series-${n%
Aa}`),width:1.5,dash:qp[Math.floor(n/2)%qp.length],points:{size:4}}))}function b0(e,t){return{width:t,height:Jp,legend:{
show:!1},padding:[8,24,0,0],cursor:{sync:{key:"time"},drag:{x:!0,y:!1,setScale:!1},focus:{prox:-1}},scales:{x:{time:!0,auto:!1},
0:{range:Zp},1:{range:Zp}},axes:v0(pe.value.flat().some(Ta),e.some(Ta)),series:[{},..._0(e)],hooks:{setSelect:[x0],setCursor:[
w0]}}}function x0(e){let{left:t,width:n}=e.select;n<4||(so({from:e.posToVal(t,"x"),to:e.posToVal(t+n,"x")}),e.setSelect(
{left:0,top:0,width:0,height:0},!1))}function w0(e){let{left:t}=e.cursor;vi.value=t==null||t<0?null:e.posToVal(t,"x")}var y0=(e,{
scale:t,offset:n})=>Array.from(e,o=>Number.isFinite(o)?o*t+n:null);function S0(e,t){let n=Jt(),o=e.map(r=>{let[l,a]=mf(ao(
r,n),t);return[l,y0(a,r)]});return o.length===1?o[0]:Ze.join(o,o.map(r=>r.map(()=>1)))}function Ma(e,t){let{from:n,to:o}=Jt();
e.batch(()=>{e.setData(S0(t,e.width),!1),e.setScale("x",{min:n,max:o})})}function k0(e,t){e.preventDefault();let{left:n,
width:o}=t.over.getBoundingClientRect();hn(e.deltaY>0?1.25:.8,(e.clientX-n)/o)}function M0(e,t){let n=new Ze(b0(t,e.clientWidth),
[[],...t.map(()=>[])],e);n.over.addEventListener("wheel",r=>k0(r,n),{passive:!1}),jp(n.over);let o=new ResizeObserver(()=>{
n.setSize({width:e.clientWidth,height:Jp})});return o.observe(e),{chart:n,destroy:()=>{o.disconnect(),n.destroy()}}}function T0(e){
let t=setInterval(()=>{!document.hidden&&It.value===null&&e()},250);return()=>clearInterval(t)}function Xp({plot:e,onChart:t}){
let n=Lt(null),o=Lt(null),r=JSON.stringify([e,pe.value.flat().some(Ta)]);return Qe(()=>{if(!n.current)return;let l=M0(n.
current,e);o.current=l.chart,t(l.chart),Ma(l.chart,e);let a=T0(()=>Ma(l.chart,e));return()=>{a(),l.destroy(),o.current=null,
t(null)}},[r,vs.value]),Qe(()=>{o.current&&Ma(o.current,e)},[Zt.value,It.value]),i("div",{class:"chart",ref:n,role:"img",
"aria-label":`Plot of ${e.map(l=>l.formula).join(", ")}`})}function Qp(e,t){return(()=>{if(t.value===null&&It.value===null)
return mn(e)?.points.latest??NaN;let{from:o,to:r}=Jt(),l=t.value??r,[a,c]=ao(e,{from:o,to:r}),d=NaN;for(let m=0;m<a.length&&
a[m]<=l;++m)d=c[m];return d})()*e.scale+e.offset}function A0(e,t,n){pe.value=pe.value.flatMap((o,r)=>{if(r!==e)return[o];let l=o.flatMap((a,c)=>c!==t?[a]:n?[{...a,...n}]:
[]);return l.length>0?[l]:[]})}function xi(e,t){let n=e.dataTransfer?.getData(Ls);if(!n)return;e.preventDefault();let{topic:o,
formula:r}=JSON.parse(n);Or(Bo(String(o),String(r)),t)}var Mn=I(""),Ht=I(""),_i=I("new"),E0=St(()=>(qt.value,[...at.values()].
filter(e=>e.schema).map(e=>e.topic).sort())),bi=St(()=>(qt.value,Ht.value===""?null:uf(Ht.value,Mn.value,e=>at.get(e)?.schema))),
Ea=St(()=>af(Ht.value,Mn.value));function N0(e){e.preventDefault(),!(Ea.value===""||Ht.value===""||bi.value)&&(Or(Bo(Ea.
value,Ht.value),_i.value==="new"?null:Number(_i.value)),Ht.value="")}function td({text:e,found:t,id:n}){return t?i("p",{
class:"fault",role:"alert",id:n,children:[i("code",{children:[e.slice(0,t.at),i("mark",{children:e.slice(t.at,t.at+1)||"\
 "}),e.slice(t.at+1)]}),i("span",{children:["at ",t.at+1,": ",t.message]})]}):null}var Na=e=>t=>{e.value=t.currentTarget.
value};function nd(){Mn.value===""&&Ht.value===""&&(Mn.value=ge.value??"")}var P0=()=>i("label",{children:["Topic",i("in\
put",{id:"topic",list:"topics",class:"mono",placeholder:"/1/1/VFR_HUD",value:Mn.value,autocomplete:"off",spellcheck:!1,onFocus:nd,
onInput:Na(Mn)}),i("datalist",{id:"topics",children:E0.value.slice(0,500).map(e=>i("option",{value:e},e))})]}),O0=()=>i(
"label",{class:"grow",children:["Formula",i("input",{id:"formula",class:"mono",placeholder:"sqrt(vx^2 + vy^2) / 100",value:Ht.
value,autocomplete:"off",spellcheck:!1,"aria-invalid":bi.value!==null,"aria-describedby":"fault",title:"Fields of anothe\
r topic have its name before them: /2/1/VFR_HUD.alt",onFocus:nd,onInput:Na(Ht)})]}),F0=()=>i("label",{children:["Into",i(
"select",{value:_i.value,onChange:Na(_i),children:[i("option",{value:"new",children:"a new plot"}),pe.value.map((e,t)=>i(
"option",{value:t,children:["plot ",t+1]},t))]})]});function C0(){let e=Mn.value!==""&&!at.has(Mn.value);return i("form",
{class:"formula",onSubmit:N0,children:[i(P0,{}),i(O0,{}),i(F0,{}),i("button",{type:"submit",disabled:Ea.value===""||Ht.value===
""||bi.value!==null,children:"Plot"}),e&&Ht.value!==""&&i("p",{class:"fault warning",children:["No ",Mn.value," has come\
 yet: the plot waits for it."]}),i(td,{text:Ht.value,found:bi.value,id:"fault"})]})}function $0(){Zt.value;let e=It.value!==
null;return i("div",{class:"toolbar",children:[i("button",{"aria-pressed":e,onClick:()=>e?zr():so(),title:"Stop or follo\
w (space)",children:[i(ue,{name:e?"play":"pause"}),e?"Follow":"Pause"]}),i("label",{children:["Last"," ",i("select",{value:pn.
value,onChange:t=>{pn.value=Number(t.currentTarget.value),zr()},children:ms.map(t=>i("option",{value:t,children:t<60?`${t}\
 s`:`${t/60} min`},t))})]}),i("span",{class:"group",children:[i("button",{onClick:()=>hn(.5),"aria-label":"Zoom in",title:"\
Zoom in (+)",children:"+"}),i("button",{onClick:()=>hn(2),"aria-label":"Zoom out",title:"Zoom out (\u2212)",children:"\u2212"})]}),
i("span",{class:"summary dim number",children:e&&`stands still \xB7 ${ut(df())} new points`})]})}function D0(e){let[,t]=ao(
e,Jt()),n=1/0,o=-1/0;for(let l of t)l<n&&(n=l),l>o&&(o=l);let r=[n*e.scale+e.offset,o*e.scale+e.offset];return[Math.min(
...r),Math.max(...r)]}function ed({label:e,value:t,onValue:n}){return i("input",{type:"number",step:"any","aria-label":e,
title:e,value:t,onChange:o=>{n(Number(o.currentTarget.value)||(e==="Scale"?1:0))}})}function L0({series:e}){Zt.value;let t=mn(
e),n=t!==void 0&&t.total===0;if(t?.fault||n)return i("td",{class:t?.fault?"error":"dim",colSpan:4,children:t?.fault?"wro\
ng formula":"waits for its first message"});let[o,r]=D0(e);return i(te,{children:[i("td",{class:"number mono strong",children:jo(
Qp(e,vi))}),i("td",{class:"dim",children:e.scale===1?t?.unit:""}),i("td",{class:"number mono dim",children:jo(o)}),i("td",
{class:"number mono dim",children:jo(r)})]})}function R0({series:e,set:t}){let n=e.axis===1,o=`Axis of ${e.formula}: ${n?
"right":"left"}`;return i(te,{children:[i("td",{children:i("button",{class:"axis","aria-label":o,title:o,onClick:()=>t({
axis:n?0:1}),children:n?"right":"left"})}),i("td",{children:i(ed,{label:"Scale",value:e.scale,onValue:r=>t({scale:r})})}),
i("td",{children:i(ed,{label:"Offset",value:e.offset,onValue:r=>t({offset:r})})}),i("td",{children:i("button",{class:"qu\
iet","aria-label":`Remove ${e.formula}`,title:"Remove",onClick:()=>t(null),children:i(ue,{name:"close"})})})]})}function I0({
series:e,at:t,index:n}){let o=mn(e)?.fault??null,r=i("tr",{children:[i("td",{children:i("i",{class:`swatch s${n%Aa} d${Math.
floor(n/2)%4}`})}),i("th",{scope:"row",class:"mono",children:i("span",{class:"cut",title:`${e.formula} of ${e.topic}`,children:[
e.formula," ",!e.formula.includes(e.topic)&&i("span",{class:"dim",children:e.topic})]})}),i(L0,{series:e}),i(R0,{series:e,
set:l=>A0(t,n,l)})]});return o?i(te,{children:[r,i("tr",{class:"wrong",children:[i("td",{}),i("td",{colSpan:9,children:i(
td,{text:e.formula,found:o})})]})]}):r}function V0({plot:e,at:t}){return Zt.value,i("table",{class:"legend",children:[i(
"caption",{class:"hidden",children:["Series of plot ",t+1]}),i("thead",{children:i("tr",{children:[i("td",{}),i("th",{scope:"\
col",children:"Series"}),i("th",{scope:"col",class:"number",children:vi.value===null?"Latest":"Pointer"}),i("td",{}),i("\
th",{scope:"col",class:"number",children:"Least"}),i("th",{scope:"col",class:"number",children:"Most"}),i("th",{scope:"c\
ol",children:"Axis"}),i("th",{scope:"col",children:"Scale"}),i("th",{scope:"col",children:"Offset"}),i("td",{})]})}),i("\
tbody",{children:e.map((n,o)=>i(I0,{series:n,at:t,index:o},`${n.topic} ${n.formula}`))})]})}function z0({at:e,plot:t,savePicture:n}){
let o=()=>{pe.value=pe.value.filter((r,l)=>l!==e)};return i("header",{children:[i("h3",{children:["Plot ",e+1]}),i("span",
{class:"group end",children:[i("button",{onClick:()=>vf(t),title:"Save what is shown as CSV",children:"CSV"}),i("button",
{onClick:n,title:"Save the picture",children:"PNG"}),i("button",{class:"quiet",onClick:o,"aria-label":`Remove plot ${e+1}`,
title:"Remove the plot",children:i(ue,{name:"close"})})]})]})}function H0({plot:e,at:t}){let n=Lt(null),o=l=>{n.current=
l},r=()=>{n.current&&_f(n.current.ctx.canvas,e)};return i("section",{class:"panel plot","aria-label":`Plot ${t+1}`,onDragOver:l=>l.
preventDefault(),onDrop:l=>xi(l,t),children:[i(z0,{at:t,plot:e,savePicture:r}),i(Xp,{plot:e,onChart:o}),i(V0,{plot:e,at:t})]})}
function U0(){return i("div",{class:"empty start",children:[i(ue,{name:"plot"}),i("p",{children:["Open a message under ",
i("b",{children:"Messages"})," and click a number, or type a formula above."]})]})}var W0={" ":()=>It.value?zr():so(),"+":()=>hn(
.5),"=":()=>hn(.5),"-":()=>hn(2),ArrowLeft:()=>Hr(-.25),ArrowRight:()=>Hr(.25),0:zr,a:()=>Ln("#formula")};function od(){
Ro(()=>zl(W0),[]),ht.value;let e=ge.value!==null;return i(te,{children:[i("h2",{class:"hidden",children:"Plots"}),i("div",
{class:"list",onDragOver:t=>t.preventDefault(),onDrop:t=>{t.defaultPrevented||xi(t,null)},children:[i($0,{}),i(C0,{}),i(
"div",{class:"scroller",tabIndex:-1,children:pe.value.length===0?i(U0,{}):pe.value.map((t,n)=>i(H0,{plot:t,at:n},n))})]}),
e&&i(Kl,{hz:null})]})}var rd={overview:"Overview",messages:"Messages",plots:"Plots"};function ld(e){let t={view:e,query:cn.value,sort:Yt.value,
columns:fn.value,opened:ge.value,plots:pe.value,span:pn.value};return`#${$l(t)}`}var id=I(!1);ze(()=>{mt.value&&(id.value=
!0)});var sr=St(()=>mt.value?"live":id.value?"lost":"connecting"),G0=St(()=>Wo.value.filter(e=>e.ended_us===null&&e.severity!==
"info"));function Pa({to:e}){let t=e!=="plots"?{}:{onDragOver:n=>n.preventDefault(),onDrop:n=>xi(n,null)};return i("a",{
href:ld(e),"aria-current":He.value===e?"page":void 0,...t,children:rd[e]})}function B0(){let e=G0.value,t=e.some(n=>n.severity===
"error")?"error":"warning";return e.length===0?null:i("a",{class:`badge ${t}`,href:ld("overview"),children:[i(ue,{name:t}),
e.length,i("span",{class:"wide",children:[" ",e.length===1?"alarm":"alarms"]})]})}function j0(){let e={live:"live",lost:"\
lost",connecting:"opening"}[sr.value];return i("span",{class:`badge ${sr.value}`,title:Tr.value,children:[i(ue,{name:sr.
value}),e]})}function q0(){if(sr.value!=="lost")return null;ht.value;let e=Ho.value===null?0:Math.max(0,Math.ceil((Ho.value-
Date.now())/1e3));return i("div",{class:"banner",children:[i(ue,{name:"lost"}),i("span",{children:[i("strong",{children:"\
Connection lost"})," ",Kt((Date.now()-(kr.value??Date.now()))/1e3)," ago. Values are old. ",e>0?`Next attempt in ${e} s.`:
"Connecting\u2026"]}),i("button",{onClick:Ar,children:"Try now"})]})}function Y0(){return i("header",{children:[i("h1",{
children:"mavloom"}),i("nav",{"aria-label":"Views",children:[i(Pa,{to:"overview"}),i(Pa,{to:"messages"}),i(Pa,{to:"plots"})]}),
i("div",{class:"right",children:[i(B0,{}),i(j0,{}),i("button",{class:"quiet",onClick:Il,title:`Colours: ${Dn.value} (t)`,
"aria-label":`Colours: ${Dn.value}`,children:i(ue,{name:Dn.value})}),i("button",{class:"quiet",onClick:()=>{Mt.value=!0},
title:"Keys and licences (?)","aria-label":"Help",children:i(ue,{name:"help"})})]})]})}var K0={overview:lf,messages:Ic,plots:od};
function sd(){Qe(()=>to.use(),[]),Qe(()=>{document.title=`${rd[He.value]} \xB7 Mavloom`},[He.value]);let e=K0[He.value];
return i("div",{class:`app ${sr.value}`,children:[i(Y0,{}),i(q0,{}),i("main",{class:He.value,children:i(e,{})}),i("div",
{class:"notice",role:"status",hidden:Pr.value==="",children:Pr.value}),i("div",{class:"hidden",role:"status",children:sr.
value==="lost"?"The connection is lost":""}),i(vc,{})]})}ic();xc();cf();Ar();Ju();addEventListener("keydown",hc);var ad=document.getElementById("app");ad&&bu(i(sd,{}),ad);})();
